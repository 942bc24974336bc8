// How far doorways stand from where the plan has them in their walls, and how wide they were built.
#pragma once

#include <string>
#include <vector>

#include "runtime/deviations/jamb.h"
#include "runtime/deviations/wall_presence.h"
#include "runtime/mapping/sgraph.h"
#include "runtime/optimization/joint_optimizer.h"
#include "schema/agraph.h"

namespace plumb::runtime {

struct DoorwayOptions {
  JambOptions jamb;
  double tolerance_m = 0.005;        // of construction (standard deviation) that the test allows for, in shift and width each
  double min_deviation_m = 0.02;     // smaller ones are as planned, however certain
  double typical_deviation_m = 0.1;  // of doorways that deviate (standard deviation)
  double prior = 0.2;                // share of them
  double min_p_deviated = 0.95;
  double max_mdb_m = 0.1;                   // a doorway of which only larger deviations would have been found was not tested
  double max_wall_sigma_m = 0.03;           // a wall whose own place is known worse says nothing about its doorways
  double max_sight_m = 8;                   // farther lines pass too many places at once
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

// kMissing: walled up.
enum class DoorwayStatus : uint8_t { kAsPlanned, kDeviated, kMissing, kUnobserved };
[[nodiscard]] const char* StatusName(DoorwayStatus status);  // as_planned | deviated | missing | unobserved

struct DoorwayDeviation {
  DoorwayId doorway;
  DoorwayStatus status = DoorwayStatus::kUnobserved;
  // The rest is 0 where it is unobserved or missing. Of the middle along the built wall, + to the left of who passes from room_a to room_b,
  // from where it would be had the wall moved along its own normal and turned about the middle of its longest surface.
  double shift_m = 0, sigma_shift_m = 0;
  double width_deviation_m = 0, sigma_width_m = 0;  // + wider
  double p_deviated = 0;
};

// One per plan doorway. The jambs are looked for in the built frame of the wall, which must be matched and not be missing (`presence`: per
// wall; empty: none is), to 0.5 m from where they are planned, as far as there is plain wall; in a corner the next wall is the jamb; the
// plan's frames are part of the jambs. Unobserved in maps of planar lasers. `map` with the poses of `estimate`. O(keyframe points +
// doorways). Deterministic.
[[nodiscard]] std::vector<DoorwayDeviation> JudgeDoorways(const SGraph& map, const AGraph& plan, const JointResult& estimate,
                                                          const std::vector<WallPresence>& presence, const DoorwayOptions& options = {});

}  // namespace plumb::runtime
