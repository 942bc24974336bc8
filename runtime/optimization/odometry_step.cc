#include "runtime/optimization/odometry_step.h"

#include <algorithm>
#include <cmath>

namespace plumb::runtime {

OdometryResidual OdometryStep(const Keyframe& a, const Keyframe& b, const JointOptions& options) {
  OdometryResidual out;
  out.T_a_b = a.T_odom_kf.inverse() * b.T_odom_kf;
  const double length_m = std::max(out.T_a_b.translation().norm(), b.travelled_m - a.travelled_m);
  const double turn_rad = std::max(std::abs(Eigen::AngleAxisd(out.T_a_b.linear()).angle()), b.turned_rad - a.turned_rad);
  out.sigma_m = options.odometry_sigma_m + options.odometry_sigma_m_per_m * length_m +
                options.odometry_sigma_m_per_s * std::abs(b.stamp_s - a.stamp_s);
  out.sigma_rad = options.odometry_sigma_rad + options.odometry_sigma_rad_per_m * length_m + options.odometry_sigma_rad_per_rad * turn_rad;
  return out;
}

}  // namespace plumb::runtime
