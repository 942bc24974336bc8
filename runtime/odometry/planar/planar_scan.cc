#include "runtime/odometry/planar/planar_scan.h"

#include <algorithm>
#include <cmath>

#include "runtime/numerics/symmetric_eigen.h"
#include "runtime/odometry/leveling.h"

namespace plumb::runtime {
namespace {

constexpr double kMaxElevation_rad = 0.035;   // of beams over the scan plane
constexpr double kMinSpread = 0.01;           // least variance of directions within the plane: of a fan of 20 degrees
constexpr size_t kQuickPoints = 256;          // tell most scans of many rings apart
constexpr int kNeighbours = 3;                // on either side, for the normal
constexpr double kMaxNeighbour_m = 0.25;      // and no further than this, ...
constexpr double kMaxNeighbour_rad = 0.03;    // ... or at the spacing of beams
constexpr double kMaxRmsSigmas = 2.0;
constexpr int kMinNeighbours = 3;             // with the point itself

// Largest elevation over the plane that fits every `step`-th beam best, and the plane.
std::optional<Eigen::Vector3d> FitScanPlane(const std::vector<Eigen::Vector3f>& points, size_t step) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double count = 0;
  const auto for_each = [&](const auto& visit) {
    for (size_t i = 0; i < points.size(); i += step) {
      const Eigen::Vector3d p = points[i].cast<double>();
      const double range_m = p.norm();
      if (std::isfinite(range_m) && range_m > 0) visit(Eigen::Vector3d(p / range_m));
    }
  };
  for_each([&](const Eigen::Vector3d& d) {
    sum += d * d.transpose();
    ++count;
  });
  if (count < 3) return std::nullopt;
  const SymmetricEigen<3> eigen = EigenOf(Eigen::Matrix3d(sum / count));
  if (eigen.values[1] < kMinSpread) return std::nullopt;
  const Eigen::Vector3d normal = eigen.vectors.col(0) * (eigen.vectors(2, 0) < 0 ? -1.0 : 1.0);
  bool flat = true;
  for_each([&](const Eigen::Vector3d& d) { flat = flat && std::abs(normal.dot(d)) <= std::sin(kMaxElevation_rad); });
  return flat ? std::optional<Eigen::Vector3d>(normal) : std::nullopt;
}

void FindNormals(double sigma_m, PlanarScan* scan) {
  const auto n = static_cast<std::ptrdiff_t>(scan->size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    PlanarPoint& point = (*scan)[static_cast<size_t>(i)];
    const double reach_m = std::max(kMaxNeighbour_m, kMaxNeighbour_rad * point.p.norm());
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    Eigen::Matrix2d outer = Eigen::Matrix2d::Zero();
    int count = 0;
    for (std::ptrdiff_t k = i - kNeighbours; k <= i + kNeighbours; ++k) {
      const Eigen::Vector2d d = (*scan)[static_cast<size_t>((k + n) % n)].p - point.p;
      if (d.norm() > reach_m) continue;
      sum += d;
      outer += d * d.transpose();
      ++count;
    }
    if (count < kMinNeighbours) continue;
    const Eigen::Vector2d mean = sum / count;
    const SymmetricEigen<2> eigen = EigenOf(Eigen::Matrix2d(outer / count - mean * mean.transpose()));
    if (eigen.values[0] > std::pow(kMaxRmsSigmas * sigma_m, 2) || eigen.values[1] < 4 * std::max(eigen.values[0], 1e-8)) continue;
    const Eigen::Vector2d normal = eigen.vectors.col(0);
    point.normal = normal.dot(point.p) > 0 ? Eigen::Vector2d(-normal) : normal;
  }
}

}  // namespace

std::optional<Eigen::Vector3d> ScanPlaneNormal(const Scan& scan) {
  if (std::any_of(scan.ring.begin(), scan.ring.end(), [&](uint16_t ring) { return ring != scan.ring.front(); })) return std::nullopt;
  const size_t step = scan.points.size() / kQuickPoints + 1;
  if (step > 1 && !FitScanPlane(scan.points, step)) return std::nullopt;
  return FitScanPlane(scan.points, 1);
}

LeveledPose Leveled(const Eigen::Isometry3d& T_odom_lidar) {
  LeveledPose out;
  out.leveling = LevelingRotation(T_odom_lidar.linear().transpose() * Eigen::Vector3d::UnitZ());
  const Eigen::Matrix3d turn = T_odom_lidar.linear() * out.leveling.transpose();
  out.pose = {T_odom_lidar.translation().head<2>(), std::atan2(turn(1, 0), turn(0, 0))};
  out.z_m = T_odom_lidar.translation().z();
  return out;
}

PlanarScan MakePlanarScan(const PreparedScan& prepared, const Eigen::Matrix3d& leveling, const PlanarSweep& motion, double sigma_m) {
  PlanarScan scan;
  scan.reserve(prepared.points.size());
  const Pose2 moved = Between(motion.start, motion.end);
  for (const SweepPoint& point : prepared.points) {
    const Pose2 at{point.s * moved.t_m, point.s * moved.yaw_rad};
    scan.push_back({at * Eigen::Vector2d((leveling * point.p).head<2>()), Eigen::Vector2d::Zero(), point.s});
  }
  std::stable_sort(scan.begin(), scan.end(),
                   [](const PlanarPoint& a, const PlanarPoint& b) { return std::atan2(a.p.y(), a.p.x()) < std::atan2(b.p.y(), b.p.x()); });
  if (!scan.empty()) FindNormals(sigma_m, &scan);
  return scan;
}

}  // namespace plumb::runtime
