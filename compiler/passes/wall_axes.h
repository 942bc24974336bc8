// Pass: the A-Graph's walls with centre line, thickness and height.
#pragma once

#include "compiler/ir/floor_ir.h"

namespace plumb::compiler {

// Centre line and thickness of a footprint.
struct WallAxis {
  Eigen::Vector2d start = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();
  double thickness_m = 0;
};

// From the two parallel sides that face each other over the greatest length; the line runs from end to end of the footprint. `direction`
// (may be zero) restricts the choice to sides along it. Footprints without such sides (curved, irregular): the ends of the least
// rectangle around them, and the thickness of a strip of the same area and perimeter. O(E^2) for E edges.
[[nodiscard]] WallAxis AxisOfFootprint(const std::vector<Ring>& rings, const Eigen::Vector2d& direction);

// Appends one Wall per FloorIr::walls, in that order. The source's thickness counts if the footprint bears it out within 1 cm; its axis
// gives the direction only, since it may lie on a face of the wall.
void AddWalls(const PlanIr& plan, const FloorIr& floors, AGraph& graph);

}  // namespace plumb::compiler
