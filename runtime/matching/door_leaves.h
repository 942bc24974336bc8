// Which triangles of doors are leaves, which may stand open, and which are frames, which do not move.
#pragma once

#include <vector>

#include "schema/agraph.h"

namespace plumb::runtime {

// Per triangle of the mesh: the doorway whose clear opening it closes (as part of a connected piece of the door's own elements that blocks
// the passage); none: it stands wherever the leaf is. Frame and leaf in one piece are leaf. O(triangles of doors, log).
[[nodiscard]] std::vector<DoorwayId> LeafTriangles(const AGraph& plan);

}  // namespace plumb::runtime
