// Curved walls: the material between two arcs about one centre.
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/frontends/drawing/outline.h"
#include "compiler/geometry/circle.h"

namespace plumb::compiler {

inline constexpr double kSameCurve_m = 0.02;  // between circles that are meant to be one

// As far as both arcs go side by side, counter-clockwise from from_rad to to_rad (up to a full turn later).
struct CurvedWall {
  Circle middle;
  double thickness_m = 0;
  double from_rad = 0, to_rad = 0;
  uint32_t source = 0xffffffffu;  // a path that one of its arcs is drawn by
  [[nodiscard]] double inner_m() const { return middle.radius_m - 0.5 * thickness_m; }
  [[nodiscard]] double outer_m() const { return middle.radius_m + 0.5 * thickness_m; }
  [[nodiscard]] double length_m() const { return (to_rad - from_rad) * middle.radius_m; }
};

[[nodiscard]] bool IsSameCurve(const Circle& a, const Circle& b);
[[nodiscard]] double AngleAt(const Circle& circle, const Eigen::Vector2d& p);
[[nodiscard]] Eigen::Vector2d PointAt(const Circle& circle, double angle_rad);
// `angle_rad` by whole turns, so that it lies within half a turn of `near_rad`.
[[nodiscard]] double Nearest(double angle_rad, double near_rad);

// Pieces between what stands across them; in the order of the outline's sides. O(n log n) in curved sides.
[[nodiscard]] std::vector<CurvedWall> FindCurvedWalls(const Outline& outline, double max_thickness_m);

}  // namespace plumb::compiler
