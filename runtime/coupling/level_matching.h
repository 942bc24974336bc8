// Floors and ceilings of the map to rooms of the plan.
#pragma once

#include <vector>

#include "runtime/coupling/coupling.h"

namespace plumb::runtime {

// A floor (ceiling) goes to the room under (over) most of its points whose level is within options.max_level_offset_m. The height of the
// plan's place may be a guess (walls look alike at any height) or rest on a bench taken for the floor. So levels count from another height,
// up to options.max_unknown_height_m away, where far more of the floors seen fit that one; what has more than reflections below it in the
// same room is no floor, for through a floor nothing is seen (runtime/METHOD.md, The joint problem).
[[nodiscard]] std::vector<Match> MatchLevels(const SGraph& map, const AGraph& plan, const Eigen::Isometry3d& T_plan_map,
                                             const CouplingOptions& options);

}  // namespace plumb::runtime
