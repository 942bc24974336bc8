// Tells fronts of furniture by the thickness that a wall would have with them. Internal to coupling/.
#pragma once

#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/coupling/face_candidates.h"
#include "runtime/coupling/wall_frame.h"
#include "runtime/coupling/wall_patch.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// Where a wall's two faces were both seen and make it far thicker than planned, one of them is the front of furniture against it and is no
// match. A planar laser sees of a cupboard no more and no less than of a wall: there it is what stands before its plan.
void DropPlanarFronts(const std::vector<Patch>& patches, AssignedFaces& assigned);
// A lidar with many rings sees over furniture: the wall is what reaches higher, of two that reach alike what is much larger. `patches` as
// WallPatches() has them.
void DropLowFronts(const AGraph& plan, const std::vector<WallFrame>& frames, const std::vector<Patch>& patches,
                   std::vector<Match>& matches);

}  // namespace plumb::runtime
