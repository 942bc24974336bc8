// Floors and ceilings of the map to rooms of the plan.
#pragma once

#include <vector>

#include "runtime/coupling/coupling.h"

namespace plumb::runtime {

// A floor (ceiling) goes to the room under (over) most of its points whose level is within options.max_level_offset_m. Where that is so of
// no floor, the height of the plan's place is a guess (walls look alike at any height), and the best seen floor within
// options.max_unknown_height_m is where the robot stands: levels count from there.
[[nodiscard]] std::vector<Match> MatchLevels(const SGraph& map, const AGraph& plan, const Eigen::Isometry3d& T_plan_map,
                                             const CouplingOptions& options);

}  // namespace plumb::runtime
