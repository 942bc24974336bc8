// Walls in facets, which a door or a window in them may leave without any that stands from the floor to its height.
#pragma once

#include <vector>

#include "compiler/frontends/mesh/mesh_wall_grid.h"

namespace plumb::compiler {

// Facets go on in each other askew. What is open along a chain of them, between two places where it stands as a wall, is held by the wall
// as openings in a straight wall are, if it is no longer than `max_opening_m`. O(n log n) in stretches of wall.
void HoldFacets(const std::vector<FaceDirection>& directions, double max_opening_m, std::vector<WallGrid>& grids);

}  // namespace plumb::compiler
