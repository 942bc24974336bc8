// Where the plan's walls stand, and the house's triangles after some of them were moved.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "schema/agraph.h"
#include "tools/simulate/rectangle.h"

namespace plumb::tools {

inline constexpr double kMinCrossingSine = 0.25;  // about 15 degrees: walls at flatter angles have no joint to slide along

struct WallBody {
  Rectangle footprint;  // plan frame, from the wall's own triangles (from its axis and thickness where it has none)
  double z_min_m = 0, z_max_m = 0;
  bool curved = false;
};

// One per plan wall.
[[nodiscard]] std::vector<WallBody> FindWallBodies(const AGraph& plan);

// True if the element is part of a wall, not something that the wall hosts.
[[nodiscard]] bool IsWallBody(const Element& element);

// Two walls meet where an end of the one touches the other.
[[nodiscard]] bool Meet(const WallBody& a, const WallBody& b);
// Sine of the angle between two walls.
[[nodiscard]] double CrossingSine(const WallBody& a, const WallBody& b);

// Moves each wall w by motions[w] (plan frame), with what it hosts. Where the end of a wall touches another wall, its vertices keep
// their distance from the faces of both: walls lengthen or shorten along their own axis, every face stays plane, joints stay closed.
// Under and over the ground that an outer wall leaves, strips at floor and ceiling height close the slabs' edge. O(vertices x walls).
[[nodiscard]] Mesh MoveWalls(const AGraph& plan, const std::vector<WallBody>& bodies, const std::vector<Eigen::Isometry2d>& motions);

}  // namespace plumb::tools
