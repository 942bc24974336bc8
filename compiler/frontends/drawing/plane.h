// Small things of plane geometry that reading drawings needs throughout.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <span>
#include <vector>

#include "compiler/frontends/drawing/line_map.h"

namespace plumb::compiler {

inline constexpr uint32_t kNone = 0xffffffffu;

[[nodiscard]] inline double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }
[[nodiscard]] inline Eigen::Vector2d Perp(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }  // to the left

[[nodiscard]] Eigen::AlignedBox2d BoxOf(std::span<const Eigen::Vector2d> points);
[[nodiscard]] double AreaOf(std::span<const Eigen::Vector2d> ring);  // whichever way round
[[nodiscard]] double LengthAround(std::span<const Eigen::Vector2d> ring);
// The narrow side of the rectangle around `ring` that is turned as its longest side.
[[nodiscard]] double LesserSide(std::span<const Eigen::Vector2d> ring);
[[nodiscard]] double DistanceToLine(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b);  // between its ends

// Lines that go on in each other, or lie over each other, as one. Order: by first part.
[[nodiscard]] std::vector<MapLine> MergeCollinear(std::vector<MapLine> lines, double tolerance_m);

}  // namespace plumb::compiler
