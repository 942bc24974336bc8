// Proposes where the map may lie in the plan: every pair of a map wall and a plan face votes for the poses under which one lies on the
// other.
#pragma once

#include <vector>

#include "runtime/matching/map_view.h"
#include "runtime/matching/plan_index.h"
#include "runtime/matching/planar_pose.h"

namespace plumb::runtime {

struct Proposal {
  PlanarPose pose;
  size_t level = 0;  // PlanIndex::levels
  double votes = 0;  // metres of map wall that lie on plan walls
};

// The height that puts the map's floor (or else its ceiling, or else a sensor 0.6 m above ground) onto a level.
[[nodiscard]] double HeightOnLevel(const MapView& map, const PlanLevel& level);

// Yaws (plan from map) at which many wall normals agree, best first.
[[nodiscard]] std::vector<double> YawPeaks(const PlanIndex& plan, const MapView& map, const MatcherOptions& options);

// At most options.max_hypotheses, most votes first, no two closer than options.nms_radius_m at about the same yaw and level.
// O(levels * yaws * (pairs of walls) * (length / cell)). Deterministic at any number of threads.
[[nodiscard]] std::vector<Proposal> ProposePoses(const PlanIndex& plan, const MapView& map, const MatcherOptions& options);

}  // namespace plumb::runtime
