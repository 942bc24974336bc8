// Which of its candidates every patch is of, so that all patches of one side of a wall lie on one line. Internal to coupling/.
#pragma once

#include <functional>
#include <vector>

#include "runtime/coupling/face_candidates.h"
#include "runtime/coupling/wall_patch.h"

namespace plumb::runtime {

// Would a wall in the patch's plane, of the planned surface's extent, stand in the way of what was seen?
using IsSeenThroughBy = std::function<bool(const Patch&, SurfaceId)>;

// `candidates` per patch. What is left of them, the best first; none: the patch is of no wall. Lines that compete for a side are decided by
// the least sum of costs; one that hides another, and one that is seen through, pay for it, unless they are taken for a wall of glass.
[[nodiscard]] AssignedFaces AssignFaces(const std::vector<Patch>& patches, AssignedFaces candidates, const IsSeenThroughBy& is_seen_through,
                                        const CouplingOptions& options);

}  // namespace plumb::runtime
