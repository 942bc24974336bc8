// Whether what was taken for a wall off its plan is what the plan itself has there: the faces of storefronts, pillars and layered walls are
// not always where their triangles are.
#pragma once

#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/mapping/sgraph.h"
#include "runtime/optimization/joint_optimizer.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// Per match: what was seen lies on triangles of the plan, all along, and not on the face that it was matched to, from which it is at least
// twice as far. O(cells of the matched surfaces * log triangles).
[[nodiscard]] std::vector<bool> MatchesOnOtherShapes(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches,
                                                     const JointResult& estimate);

// Per plan wall: most of what `matches` give it is so. Walls as planned, and those that nothing was matched to: false.
[[nodiscard]] std::vector<bool> LieOnOtherShapes(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches,
                                                 const JointResult& estimate);

}  // namespace plumb::runtime
