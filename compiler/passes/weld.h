// Points that lie closer together than a radius become one.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace plumb::compiler {

struct Welded {
  std::vector<Eigen::Vector2d> points;  // the mean of each cluster, in lexicographic order of their first members
  std::vector<uint32_t> index;          // per input point: its cluster
};

// Greedy in lexicographic order: a point joins the nearest cluster that began within `radius_m` of it, else begins one.
// The order of the input does not matter. Expected O(n log n).
[[nodiscard]] Welded Weld(const std::vector<Eigen::Vector2d>& points, double radius_m);

}  // namespace plumb::compiler
