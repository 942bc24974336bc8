// Circles through points of the plane.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace plumb::compiler {

struct Circle {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double radius_m = 0;  // in the points' unit
};

// Least squares of |p|^2 = 2 c . p + k about the points' mean (Kasa): exact for points on a circle, as corners of facets are. None for
// fewer than three points and for points on a line. O(n).
[[nodiscard]] std::optional<Circle> FitCircle(std::span<const Eigen::Vector2d> points);

}  // namespace plumb::compiler
