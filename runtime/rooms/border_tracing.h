// The borders of a region of cells, as closed ways along the cells' sides.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "runtime/rooms/floor_grid.h"

namespace plumb::runtime {

// One side of a cell, with the region on its left.
struct BorderStep {
  Eigen::Vector2i from = Eigen::Vector2i::Zero();  // grid corner: (x, y) is the lower left one of cell (x, y)
  int direction = 0;                               // 0 +x, 1 +y, 2 -x, 3 -y
};
using Border = std::vector<BorderStep>;

[[nodiscard]] Eigen::Vector2i StepOf(int direction);
// The cell on the right of a step: outside of the region, maybe of the grid.
[[nodiscard]] Eigen::Vector2i OutsideOf(const BorderStep& step);

// All borders of the region with this label, whose cells lie in [lo, hi]; cells belong together if they share a side. Outer ones run
// counter-clockwise, those of holes clockwise. In order of their lowest corner. O(cells in [lo, hi]).
[[nodiscard]] std::vector<Border> TraceBorders(const FloorGrid& grid, const std::vector<int32_t>& label, int32_t region,
                                               const Eigen::Vector2i& lo, const Eigen::Vector2i& hi);

}  // namespace plumb::runtime
