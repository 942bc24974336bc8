// Plans other than the house, and plans changed: mirrored, scaled, built otherwise.
#pragma once

#include <cstdint>
#include <vector>

#include "schema/agraph.h"

namespace plumb::test {

// A door without a leaf in a wall of a grid plan: in the line `line` of the vertical (x = const) or horizontal lines, between the lines
// `cell` and `cell` + 1 of the other kind, its middle at `ratio` of that.
struct GridDoor {
  bool vertical = true;
  size_t line = 0, cell = 0;
  double ratio = 0.5;
};

// Rooms between straight walls: `xs` and `ys` are the walls' centre lines, 0.2 m thick. With floor and ceiling.
[[nodiscard]] AGraph MakeGridPlan(const std::vector<double>& xs, const std::vector<double>& ys, const std::vector<GridDoor>& doors);

// columns x rows rooms of 2.5 m to 6 m with random doors.
[[nodiscard]] AGraph MakeRandomPlan(uint64_t seed, int columns, int rows);

// x -> -x.
[[nodiscard]] AGraph Mirrored(AGraph plan);
[[nodiscard]] AGraph Scaled(AGraph plan, double scale);

// As built: moves a wall's triangles along its first surface's normal and turns them about that surface's midpoint. The rest of the graph
// stays as planned.
void DeviateWall(AGraph& graph, WallId wall, double offset_m, double yaw_rad);

}  // namespace plumb::test
