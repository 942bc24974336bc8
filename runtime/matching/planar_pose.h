// Where a gravity-aligned map lies in the plan: yaw and translation.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace plumb::runtime {

// x_plan = Rz(yaw) x_map + t. Inside matching, "map" is the map shifted so that its walls' middle is at the origin of x and y
// (MapView::center_m): yaw and translation are then nearly independent. "Plan" is the frame of the A-Graph's mesh.
struct PlanarPose {
  double yaw_rad = 0;
  Eigen::Vector2d t_m = Eigen::Vector2d::Zero();
  double z_m = 0;

  [[nodiscard]] Eigen::Matrix2d rotation() const {
    const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
    return (Eigen::Matrix2d() << c, -s, s, c).finished();
  }
};

// To (-pi, pi].
[[nodiscard]] inline double WrapAngle(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

[[nodiscard]] inline double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace plumb::runtime
