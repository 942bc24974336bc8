#include "runtime/mapping/odometry_drift.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb::runtime {

std::string OdometryDrift::Check() const {
  for (const auto& [name, value] : {std::pair{"sigma_m", sigma_m}, {"sigma_rad", sigma_rad}}) {
    if (!(value > 0)) return fmt::format("OdometryDrift.{} = {}; must be > 0", name, value);
  }
  for (const auto& [name, value] : {std::pair{"sigma_m_per_m", sigma_m_per_m},
                                    {"sigma_rad_per_m", sigma_rad_per_m},
                                    {"sigma_rad_per_rad", sigma_rad_per_rad},
                                    {"sigma_m_per_s", sigma_m_per_s}}) {
    if (!(value >= 0)) return fmt::format("OdometryDrift.{} = {}; must be >= 0", name, value);
  }
  return {};
}

StepSigma OdometryDrift::Between(const Keyframe& a, const Keyframe& b) const {
  const Eigen::Isometry3d T_a_b = a.T_odom_kf.inverse() * b.T_odom_kf;
  const double length_m = std::max(T_a_b.translation().norm(), b.travelled_m - a.travelled_m);
  const double turn_rad = std::max(std::abs(Eigen::AngleAxisd(T_a_b.linear()).angle()), b.turned_rad - a.turned_rad);
  return {sigma_m + sigma_m_per_m * length_m + sigma_m_per_s * std::abs(b.stamp_s - a.stamp_s),
          sigma_rad + sigma_rad_per_m * length_m + sigma_rad_per_rad * turn_rad};
}

}  // namespace plumb::runtime
