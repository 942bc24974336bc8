#include "tools/simulate/wheel_odometry.h"

#include <cmath>
#include <numbers>

namespace plumb::tools {
namespace {

struct Pose2 {
  Eigen::Vector2d position;
  double yaw_rad;
};

Pose2 Planar(const Eigen::Isometry3d& T) { return {T.translation().head<2>(), std::atan2(T.linear()(1, 0), T.linear()(0, 0))}; }

}  // namespace

runtime::Trajectory SimulateOdometry(const Drive& drive, const SimulateOptions& options) {
  Random random(options.seed, static_cast<uint64_t>(RandomStream::kOdometry));
  const double step_s = 1 / options.odometry_rate_hz;
  const double scale = 1 + options.odometry_scale_sigma * random.Normal();
  const double bias_rad = options.odometry_yaw_bias_sigma_rad_s * random.Normal() * step_s;
  const double walk_rad = options.odometry_yaw_walk_rad_sqrt_s * std::sqrt(step_s);
  Pose2 odometry{{random.Uniform(-10, 10), random.Uniform(-10, 10)}, random.Uniform(-std::numbers::pi, std::numbers::pi)};
  const auto steps = static_cast<int>(std::ceil((drive.duration_s() + 0.2) / step_s)) + 1;
  runtime::Trajectory trajectory;
  Pose2 last = Planar(drive.PoseAt(-0.1));
  for (int i = 0; i <= steps; ++i) {
    const double time_s = -0.1 + i * step_s;
    const Pose2 now = Planar(drive.PoseAt(time_s));
    const Eigen::Vector2d moved = Eigen::Rotation2Dd(-last.yaw_rad) * (now.position - last.position);
    const double turned_rad = std::remainder(now.yaw_rad - last.yaw_rad, 2 * std::numbers::pi);
    last = now;
    const bool moving = moved.norm() > 1e-6 || std::abs(turned_rad) > 1e-6;
    if (moving) {  // wheels at rest do not drift
      const Eigen::Vector2d slip = options.odometry_slip * moved.norm() * Eigen::Vector2d(random.Normal(), random.Normal());
      odometry.position += Eigen::Rotation2Dd(odometry.yaw_rad) * (scale * moved + slip);
      odometry.yaw_rad += turned_rad + bias_rad + walk_rad * random.Normal();
    }
    runtime::StampedPose pose;
    pose.stamp_s = options.start_stamp_s + time_s;
    pose.T.translation() << odometry.position, 0;
    pose.T.linear() = Eigen::AngleAxisd(odometry.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    trajectory.push_back(pose);
  }
  return trajectory;
}

}  // namespace plumb::tools
