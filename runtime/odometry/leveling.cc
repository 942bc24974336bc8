#include "runtime/odometry/leveling.h"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "runtime/numerics/symmetric_eigen.h"
#include "runtime/odometry/se3.h"

namespace plumb::runtime {
namespace {

constexpr double kBand_m = 0.06;           // surfels of one floor lie within this of its plane
constexpr double kSameNormalCos = 0.99;    // 8 degrees
constexpr double kMinFloorCount = 80;      // points
constexpr double kWallSigma_rad = 0.01;    // of surfels about plumb, besides their points' noise
constexpr double kMaxSigma_rad = 0.0087;
constexpr int kRounds = 4;

// Statistics of all surfels that lie on the plane through `mean` with `normal`.
Surfel Supporters(const std::vector<const Surfel*>& candidates, const Eigen::Vector3d& normal, const Eigen::Vector3d& mean) {
  Surfel sum;
  for (const Surfel* s : candidates) {
    if (s->normal.dot(normal) >= kSameNormalCos && std::abs(normal.dot(s->mean - mean)) <= kBand_m) sum.Add(*s);
  }
  return sum;
}

// The plane with most points among surfels that all face up, or all down.
Surfel LargestLevel(const std::vector<const Surfel*>& candidates) {
  Surfel best;
  for (const Surfel* s : candidates) {
    const Surfel support = Supporters(candidates, s->normal, s->mean);
    if (support.count > best.count) best = support;
  }
  return best.count >= kMinFloorCount ? best : Surfel();
}

}  // namespace

std::optional<Eigen::Vector3d> FindUp(const SurfelMap& map, double max_tilt_rad) {
  const double noise_m2 = map.options().range_sigma_m * map.options().range_sigma_m;
  std::vector<const Surfel*> floors, ceilings, walls;
  const double candidate_rad = max_tilt_rad + 0.07;  // single surfels' normals are off by a few degrees themselves
  for (const Surfel& s : map.surfels()) {
    if (!s.planar) continue;
    if (s.normal.z() > std::cos(candidate_rad)) floors.push_back(&s);
    if (s.normal.z() < -std::cos(candidate_rad)) ceilings.push_back(&s);
    if (std::abs(s.normal.z()) < std::sin(candidate_rad)) walls.push_back(&s);
  }
  // Cost of a direction g: floor and ceiling, sum (g . (p - mean))^2 / noise; walls, sum (g . n)^2 / variance of n in the direction of g,
  // with a robust kernel: surfels in corners lean.
  const Eigen::Matrix3d level = (LargestLevel(floors).scatter + LargestLevel(ceilings).scatter) / noise_m2;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double off_rad = candidate_rad;
  for (int round = 0; round < kRounds; ++round, off_rad = std::max(0.5 * off_rad, 0.035)) {
    Eigen::Matrix3d cost = level;
    for (const Surfel* s : walls) {
      const double tilt_rad = s->normal.dot(up);
      if (std::abs(tilt_rad) > std::sin(off_rad)) continue;
      const double variance = noise_m2 / up.dot(s->scatter * up) + kWallSigma_rad * kWallSigma_rad;
      cost += s->normal * s->normal.transpose() / (variance + (round > 0 ? tilt_rad * tilt_rad : 0));  // Cauchy
    }
    const SymmetricEigen<3> eigen = EigenOf(cost);
    if (eigen.values[1] < 1 / (kMaxSigma_rad * kMaxSigma_rad)) return std::nullopt;
    up = eigen.vectors.col(0);
    if (up.z() < 0) up = -up;
  }
  if (up.z() < std::cos(max_tilt_rad)) return std::nullopt;
  return up;
}

Eigen::Matrix3d LevelingRotation(const Eigen::Vector3d& up) {
  const Eigen::Matrix3d R = LeastRotation(up, Eigen::Vector3d::UnitZ());
  const double yaw_rad = std::atan2(R(1, 0), R(0, 0));
  return Eigen::AngleAxisd(-yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() * R;
}

}  // namespace plumb::runtime
