// Judges a pose by its rays: what the plan says each should have measured against what it did.
#pragma once

#include <cstddef>
#include <span>

#include "runtime/matching/map_view.h"
#include "runtime/matching/plan_index.h"
#include "runtime/matching/planar_pose.h"

namespace plumb::runtime {

struct RayEvidence {
  double log_likelihood = 0;   // nats, relative to "outside the plan"; correlation taken out
  double explained_ratio = 0;  // of the judged rays: ended on what the plan has there
  double through_ratio = 0;    // of the judged rays: went through a wall of the plan
  double in_front_ratio = 0;   // of the judged rays: ended on something in front of what the plan has there
  int judged = 0;              // rays for which the plan has something to say
};

// log of the density of a measured range under the plan over its density under the background, one ray.
// `expected_m` < 0: nothing there. Mixture of a hit (as planned, or deviated), something in front, something random; passing through
// is capped. Exposed for tests.
struct RayModel {
  double range_sigma_m = 0.03, deviation_sigma_m = 0.10;
  // incidence: |cosine| between ray and surface; normals: +1 the map's wall there has the plan's normal, -1 it has another, 0 unknown.
  [[nodiscard]] double HitDensity(double range_m, double expected_m, double incidence, int normals) const;
};

// Uses every `stride`-th ray and scales to all. Thread-safe.
[[nodiscard]] RayEvidence JudgeRays(const PlanIndex& plan, const MapView& map, const PlanarPose& pose, const MatcherOptions& options,
                                    size_t stride = 1);

// By how much `pose` is better than the best of `others`, in nats, each time without what the rays that should end on one wall say, of all
// walls that which says most: a wall that deviates must not decide alone. `either`: on a wall that they should end on from `pose` or from
// the other, as in another storey, where other walls stand. Infinite without others. Thread-safe.
[[nodiscard]] double LeadOver(const PlanIndex& plan, const MapView& map, const PlanarPose& pose, std::span<const PlanarPose> others,
                              const MatcherOptions& options, size_t stride = 1, bool either = false);

}  // namespace plumb::runtime
