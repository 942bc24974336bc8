// How much of each wall was seen.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "runtime/coupling/wall_frame.h"
#include "runtime/optimization/joint_optimizer.h"

namespace plumb::runtime {

// Fills in num_points, observed_m2, span_m, seen_m and seen of `walls`, which are by wall id and hold every wall that `matches` see. Views
// that are not of the wall they were matched to do not count. Frames as named; O(matches x surfaces of the plan).
void CountSeen(const SGraph& map, const AGraph& plan, const std::vector<WallFrame>& frames, const std::vector<Match>& matches,
               const Eigen::Isometry3d& T_plan_map, std::vector<WallEstimate>& walls);

}  // namespace plumb::runtime
