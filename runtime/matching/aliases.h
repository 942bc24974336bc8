// Poses that a plan's own symmetries make look alike.
#pragma once

#include <vector>

#include "runtime/matching/planar_pose.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// Where each of the plan's aliases takes a pose, forth and back; once if that is the same, as for half turns.
[[nodiscard]] std::vector<PlanarPose> AliasedPoses(const AGraph& plan, const PlanarPose& pose);

}  // namespace plumb::runtime
