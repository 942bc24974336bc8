// Gaps of full height between pieces of walls: those that a person takes for doorways, and cavities between the skins of one wall.
#pragma once

#include "compiler/frontends/mesh/mesh_wall_set.h"

namespace plumb::compiler {

// Between two ends in one line; the later piece joins the first one if both are of one group. The gap becomes a void.
void CloseGapsInLine(const MeshOptions& options, WallSet& walls);

// From a wall's end to the flank of another one a door's width before it.
void CloseGapsToFlanks(const MeshOptions& options, WallSet& walls);

// The shorter one of two skins takes the cavity between them.
void CloseCavities(const MeshOptions& options, WallSet& walls);

}  // namespace plumb::compiler
