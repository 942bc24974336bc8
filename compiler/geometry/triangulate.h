// Triangulation of polygons with holes, in the plane and in space.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "compiler/geometry/solid.h"

namespace plumb::compiler {

using Ring2 = std::vector<Eigen::Vector2d>;  // not closed: the last point is not the first again
using Ring3 = std::vector<Eigen::Vector3d>;

struct Triangulation2 {
  // The points of all rings one after the other, then points where sides cross each other (none in proper polygons).
  std::vector<Eigen::Vector2d> points;
  std::vector<Eigen::Vector3i> triangles;  // counter-clockwise
};

[[nodiscard]] double SignedArea(std::span<const Eigen::Vector2d> ring);  // positive: counter-clockwise

// Drops points that repeat their predecessor within `tolerance_m`, and the last one if it repeats the first.
template <class Point>
void DropRepeatedPoints(double tolerance_m, std::vector<Point>& ring) {
  const auto same = [&](const Point& a, const Point& b) { return (a - b).squaredNorm() <= tolerance_m * tolerance_m; };
  size_t kept = 0;
  for (size_t i = 0; i < ring.size(); ++i) {
    if (kept == 0 || !same(ring[kept - 1], ring[i])) ring[kept++] = ring[i];
  }
  while (kept > 1 && same(ring[0], ring[kept - 1])) --kept;
  ring.resize(kept);
}

// The area inside an odd number of the rings, whatever their orientation. Every point of the rings is a corner of a triangle, so that the
// result fits to its neighbours. Rings may touch or cross. Triangles and strictly convex polygons are done directly, the rest by a
// constrained Delaunay triangulation with exact predicates (CGAL). No triangles for degenerate input, and for rings whose sides cross more
// often than they have corners. O(n log n) for usual rings.
[[nodiscard]] Triangulation2 TriangulatePolygon(std::span<const Ring2> rings);

// A face in space, outer ring counter-clockwise seen from outside, appended to `solid` with the outer ring's orientation. The face is
// projected along its normal (Newell); slightly unplanar rings keep their points. False: degenerate, nothing was appended.
bool AppendFace(std::span<const Ring3> rings, Solid& solid);

}  // namespace plumb::compiler
