// Refines a pose on the rays, where the walls leave it open.
#pragma once

#include "runtime/matching/map_view.h"
#include "runtime/matching/plan_index.h"
#include "runtime/matching/planar_pose.h"
#include "runtime/matching/refine.h"

namespace plumb::runtime {

// The pose about `fit` with the highest posterior: by a part of the rays, and by what a majority of walls fixes (WallFit::information).
// Walls of planar maps fix nothing, as half of them are furniture. Moves by 0.9 m or 9 degrees at most. About 100
// times JudgeRays() on 1000 rays at most. Deterministic, thread-safe.
[[nodiscard]] PlanarPose RefineOnRays(const PlanIndex& plan, const MapView& map, const WallFit& fit, const MatcherOptions& options);

}  // namespace plumb::runtime
