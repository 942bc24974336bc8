// Small things of plane geometry that the drawings share.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace plumb::tools {

[[nodiscard]] inline Eigen::Vector2d Direction(double yaw_rad) { return {std::cos(yaw_rad), std::sin(yaw_rad)}; }
[[nodiscard]] inline Eigen::Vector2d Left(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

}  // namespace plumb::tools
