// Walls that a cut through the plan's triangles does not show: meshes are open shells, and not every outline of theirs closes.
#pragma once

#include <vector>

#include "tools/drawing/section.h"

namespace plumb::tools {

// Rectangles along the axes of the storey's straight walls of whose `segments` at height `z_m` some are in no closed ring of `sections`, or
// that have none: where the sections do not fill the wall's thickness, openings at that height left out. Pieces under 0.1 m are the ends of
// walls that meet. A wall whose outline closes ends where it ends, under a roof for one. O(walls * sections).
[[nodiscard]] std::vector<Ring> UndrawnWalls(const AGraph& graph, StoreyId storey, double z_m, const std::vector<SectionSegment>& segments,
                                             const std::vector<ElementSection>& sections);

}  // namespace plumb::tools
