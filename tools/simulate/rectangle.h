// Rectangles in the plane at any angle: footprints of walls, openings and boxes.
#pragma once

#include <Eigen/Geometry>
#include <array>

namespace plumb::tools {

struct Rectangle {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  // unit
  double half_length_m = 0, half_width_m = 0;        // along, across

  [[nodiscard]] Eigen::Vector2d across() const { return {-along.y(), along.x()}; }
  [[nodiscard]] Rectangle Grown(double length_m, double width_m) const {
    return {center, along, half_length_m + length_m, half_width_m + width_m};
  }
  [[nodiscard]] Rectangle Moved(const Eigen::Isometry2d& T) const { return {T * center, T.linear() * along, half_length_m, half_width_m}; }
  [[nodiscard]] bool Contains(const Eigen::Vector2d& p) const {
    return std::abs((p - center).dot(along)) <= half_length_m && std::abs((p - center).dot(across())) <= half_width_m;
  }
  // Counter-clockwise.
  [[nodiscard]] std::array<Eigen::Vector2d, 4> Corners() const {
    const Eigen::Vector2d u = half_length_m * along, v = half_width_m * across();
    return {center - u - v, center + u - v, center + u + v, center - u + v};
  }
};

// By separating axes; rectangles that only touch do not overlap.
[[nodiscard]] inline bool Overlap(const Rectangle& a, const Rectangle& b) {
  for (const Eigen::Vector2d& axis : {a.along, a.across(), b.along, b.across()}) {
    const auto reach = [&axis](const Rectangle& r) {
      return r.half_length_m * std::abs(axis.dot(r.along)) + r.half_width_m * std::abs(axis.dot(r.across()));
    };
    if (std::abs(axis.dot(a.center - b.center)) >= reach(a) + reach(b)) return false;
  }
  return true;
}

}  // namespace plumb::tools
