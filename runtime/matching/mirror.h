// The plan's mirror image: a building with the same rooms that is not the plan.
//
// It measures what a map gains from a wrong plan. A map that fits the mirror image as well as the plan (one rectangular room with its
// door in the middle) does not yet tell the building from others; a pose must beat the best pose in the mirror image, too.
#pragma once

#include "runtime/matching/plan_index.h"
#include "runtime/matching/planar_pose.h"
#include "runtime/matching/refine.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// Across the plane x = AGraph::origin.x(); what matching reads of a plan but its triangles, no more: PlanIndex shares those.
[[nodiscard]] AGraph MirrorImage(const AGraph& plan);

// A map fitted to the plan and at `mirrored_pose` in its mirror image relates the two by a reflection of the plan. True if that takes the
// plan's walls onto walls of it, nearly all of those that the map lies on and most of the others, and the doorways in the former onto
// doorways: then what the mirror image shows there is the plan itself. O(faces^2).
[[nodiscard]] bool IsOwnMirrorImage(const PlanIndex& plan, const WallFit& fit, const PlanarPose& mirrored_pose);

}  // namespace plumb::runtime
