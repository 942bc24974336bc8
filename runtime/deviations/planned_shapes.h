// Whether what was taken for a wall off its plan is what the plan itself has there: the faces of storefronts, pillars and layered walls are
// not always where their triangles are.
#pragma once

#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/mapping/sgraph.h"
#include "runtime/optimization/joint_optimizer.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// Per plan wall: most of what `matches` give it lies on triangles of the plan, all along. Walls that nothing was matched to: false.
// O(cells of the matched surfaces * log triangles).
[[nodiscard]] std::vector<bool> ShapesAsPlanned(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches,
                                                const JointResult& estimate);

}  // namespace plumb::runtime
