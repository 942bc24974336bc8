// Floors and ceilings of the map to rooms of the plan.
#pragma once

#include <vector>

#include "runtime/coupling/coupling.h"

namespace plumb::runtime {

// A floor (ceiling) goes to the room under (over) most of its points whose level is within options.max_level_offset_m.
[[nodiscard]] std::vector<Match> MatchLevels(const SGraph& map, const AGraph& plan, const Eigen::Isometry3d& T_plan_map,
                                             const CouplingOptions& options);

}  // namespace plumb::runtime
