// Where to drive so that the places which a match leaves open are told apart.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/matching/matcher.h"
#include "runtime/matching/plan_index.h"

namespace plumb::runtime {

struct GuidanceOptions {
  double max_walk_m = 40;
  int max_stops = 24;           // rooms entered and looked into, nearest first
  int max_rivals = 4;           // of the best hypothesis
  int num_azimuths = 120;       // rays of a look around
  double seen_ratio = 0.5;      // of a look's rays end on what the plan has there; the others on furniture
  int keyframes_per_stop = 3;   // that a visit leaves
  double known_radius_m = 1.5;  // a stop as near as this to a keyframe tells nothing new
  [[nodiscard]] std::string Check() const;
};

// A room to drive into. As seen from the robot it lies there under every hypothesis; which room of the plan it is differs.
struct Goal {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // under the best hypothesis, plan frame, on the floor
  std::vector<RoomId> rooms;     // under the best hypothesis and under each of the `rivals`; none: in none
  double bearing_rad = 0;        // where the way begins, counter-clockwise from where the robot looks, in (-pi, pi]
  double distance_m = 0;         // along doorways
  double expected_nats = 0;      // by which the way there tells the best hypothesis from the rivals that it rules out, least of them
  int rivals_split = 0;          // whom it rules out, or who rule out the best
};

struct Guidance {
  int rivals = 0;            // hypotheses 1 to `rivals` of the match, within accept_margin_nats of the best and max_rivals at most
  std::optional<Goal> goal;  // none: nothing within max_walk_m tells any of them from the best
};

// The nearest room that tells the best hypothesis of `match` from all its rivals, else from as many as can be. What the walk would show is
// cast in the plan and judged by the ray model under either hypothesis, whichever is true. None if the match is unique, has no rivals or is
// no better than "outside the plan". `T_map_lidar`: the robot. Deterministic; max_stops * num_azimuths * max_rivals * 4 rays at most.
[[nodiscard]] std::optional<Guidance> Guide(const PlanIndex& plan, const SGraph& map, const MatchResult& match,
                                            const Eigen::Isometry3d& T_map_lidar, const MatcherOptions& options,
                                            const GuidanceOptions& guidance = {});

}  // namespace plumb::runtime
