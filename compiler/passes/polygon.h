// Plane geometry of rings (schema/agraph.h): closed polygons, several of which make a region by winding number.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "compiler/geometry/triangulate.h"
#include "schema/agraph.h"
#include "schema/polygon.h"

namespace plumb::compiler {

[[nodiscard]] inline double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }
[[nodiscard]] inline Eigen::Vector2d Rot90Ccw(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }
[[nodiscard]] inline bool LexicographicallyLess(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
}

// Area centroid of an outer ring with clockwise holes; the mean of the points where there is no area.
[[nodiscard]] Eigen::Vector2d Centroid(std::span<const Ring> rings);

// Times that the rings go counter-clockwise around `p`; != 0 is inside. Points on an edge may count as either side.
[[nodiscard]] int WindingNumber(std::span<const Ring> rings, const Eigen::Vector2d& p);

// Area that is inside both regions. For E edges together, A of them at one height: O((E + crossings) * A), exact up to 16,384 ends and
// crossings; for more, which no building has, from as many rows.
[[nodiscard]] double OverlapArea(std::span<const Ring> a, std::span<const Ring> b);
[[nodiscard]] double RegionArea(std::span<const Ring> rings);

// Corners of what is inside both regions, in no particular order. O(E^2).
[[nodiscard]] std::vector<Eigen::Vector2d> CommonCorners(std::span<const Ring> a, std::span<const Ring> b);

// Without the vertices that lie within `tolerance_m` of the line through their neighbours, and without spikes. May come back empty.
[[nodiscard]] Ring Simplified(const Ring& ring, double tolerance_m);

[[nodiscard]] double DistanceToRings(const Eigen::Vector2d& p, std::span<const Ring> rings);
[[nodiscard]] Eigen::AlignedBox2d BoundingBox(std::span<const Ring> rings);

// Its corners, counter-clockwise; all distinct points in order where they lie on a line.
[[nodiscard]] std::vector<Eigen::Vector2d> ConvexHull(std::vector<Eigen::Vector2d> points);

// Corners of the rectangle of least area around the points, counter-clockwise; fewer than 4 if they lie on a line.
[[nodiscard]] Ring LeastRectangle(std::vector<Eigen::Vector2d> points);

}  // namespace plumb::compiler
