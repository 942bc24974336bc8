// The plan's mirror image: a building with the same rooms that is not the plan.
//
// It measures what a map gains from a wrong plan. A map that fits the mirror image as well as the plan (one rectangular room with its
// door in the middle) does not yet tell the building from others; a pose must beat the best pose in the mirror image, too.
#pragma once

#include "runtime/matching/plan_index.h"
#include "runtime/matching/planar_pose.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// Across the plane x = AGraph::origin.x(); what matching reads of a plan but its triangles, no more: PlanIndex shares those.
[[nodiscard]] AGraph MirrorImage(const AGraph& plan);

// A map at `pose` in the plan and at `mirrored_pose` in its mirror image relates the two by a reflection of the plan. True if that takes
// (nearly) all walls of the plan onto walls of it, and its doorways onto doorways: then the mirror image is the plan itself. O(faces^2).
[[nodiscard]] bool IsOwnMirrorImage(const PlanIndex& plan, const PlanarPose& pose, const PlanarPose& mirrored_pose);

}  // namespace plumb::runtime
