// The poses of the newest keyframes in the map as it stands: what a solve over everything would make of them, at a cost that does not grow
// with the map (runtime/README.md).
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/optimization/joint_optimizer.h"

namespace plumb::runtime {

// T_map_kf of the newest `count` keyframes, oldest first; all others stay. Every surface that they see is a free plane, held by what all
// other keyframes together saw of it. Neither plan nor deviations are in it: the map has been laid on them by the last joint solve. Empty
// if the map has no more than `count` keyframes or there is no usable solution. O(observations of the surfaces seen), no solve over them.
[[nodiscard]] std::vector<Eigen::Isometry3d> OptimizeWindow(const SGraph& map, size_t count, const JointOptions& options);

}  // namespace plumb::runtime
