// Makes the outlines of neighbouring footprints meet: afterwards segments touch in shared vertices only (up to rounding).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace plumb::compiler {

// A piece of a footprint's outline, the footprint on its left.
struct SnapSegment {
  uint32_t from = 0, to = 0;  // vertices
  uint32_t footprint = 0;
};

struct SnapGraph {
  std::vector<Eigen::Vector2d> vertices;
  std::vector<SnapSegment> segments;
  bool is_planar = false;  // by exact predicates: segments that do not run along each other have at most ends in common
};

// Vertices within `radius_m` of each other become their mean; a vertex within `radius_m` of a segment moves onto it and splits it;
// segments that cross are split there. Repeats until nothing changes, a few times at most: what is left is for exact arithmetic,
// and `is_planar` of the result says whether anything is.
// Each footprint's outline stays closed. The order of segments within `graph` does not matter to the geometry.
[[nodiscard]] SnapGraph Snap(const SnapGraph& graph, double radius_m);

}  // namespace plumb::compiler
