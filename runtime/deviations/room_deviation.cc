#include "runtime/deviations/room_deviation.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "runtime/numerics/symmetric_eigen.h"

namespace plumb::runtime {
namespace {

// Ridge, in metres of wall: far below any wall's length, so that it decides only what no wall does.
constexpr double kRidge_m = 0.01;
constexpr double kMinSupport_m = 0.3;  // least length of wall seen along each of two axes

}  // namespace

RoomDeviation DeviationOfRoom(const AGraph& plan, RoomId id, const std::vector<SurfaceDeviation>& surfaces,
                              const DeviationOptions& options) {
  const Room& room = plan.rooms[id.index()];
  RoomDeviation out;
  out.room = id;
  struct Wall {
    Eigen::Vector3d offset_row, yaw_row;  // d(motion's right-hand side) / d(offset), d(yaw)
    double sigma_offset, sigma_yaw;
  };
  std::vector<Wall> walls;
  Eigen::Matrix3d lhs = Eigen::Vector3d(kRidge_m, kRidge_m, kRidge_m).asDiagonal();
  Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
  Eigen::Matrix2d support = Eigen::Matrix2d::Zero();
  bool any_deviated = false;
  for (SurfaceId s : room.surfaces) {
    const SurfaceDeviation& d = surfaces[s.index()];
    if (d.status != SurfaceStatus::kAsPlanned && d.status != SurfaceStatus::kDeviated) continue;
    any_deviated |= d.status == SurfaceStatus::kDeviated;
    const Surface& surface = plan.surfaces[s.index()];
    const Eigen::Vector2d n = surface.normal.head<2>();
    const double weight = 0.5 * surface.length_m();
    Wall wall{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), d.sigma_translation_m, d.sigma_rotation_rad};
    for (const Eigen::Vector2d& end : {surface.start, surface.end}) {
      const Eigen::Vector2d arm = end - room.center.head<2>(), own = end - surface.midpoint();
      const double own_lever = n.dot(Eigen::Vector2d(-own.y(), own.x()));
      const Eigen::Vector3d a(n.x(), n.y(), n.dot(Eigen::Vector2d(-arm.y(), arm.x())));
      lhs += weight * a * a.transpose();
      wall.offset_row += weight * a;
      wall.yaw_row += weight * own_lever * a;
    }
    rhs += wall.offset_row * d.translation_m + wall.yaw_row * d.rotation_rad;
    support += surface.length_m() * n * n.transpose();
    walls.push_back(wall);
  }
  if (EigenOf(support).values[0] < kMinSupport_m) return out;

  const Eigen::Matrix3d inverse = lhs.inverse();
  const Eigen::Vector3d motion = inverse * rhs;
  double variance = 0;
  for (const Wall& w : walls) {
    variance += (inverse * w.offset_row).head<2>().squaredNorm() * w.sigma_offset * w.sigma_offset;
    variance += (inverse * w.yaw_row).head<2>().squaredNorm() * w.sigma_yaw * w.sigma_yaw;
  }
  out.translation_m = motion.head<2>();
  out.rotation_rad = motion.z();
  out.sigma_m = std::sqrt(0.5 * variance);
  const bool moved =
      out.translation_m.norm() >= std::max(options.min_offset_m, 3 * out.sigma_m) || std::abs(out.rotation_rad) >= options.min_yaw_rad;
  out.status = any_deviated && moved ? SurfaceStatus::kDeviated : SurfaceStatus::kAsPlanned;
  return out;
}

}  // namespace plumb::runtime
