// What the matched floors and ceilings say about the height of the plan's place.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/mapping/sgraph.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// Cauchy scales of what they are off the plan, in sigmas. The robot stands on the floor, which is where the plan has it or all heights are
// off; ceilings get suspended and have beams and ducts.
inline constexpr double kFloorLoss = 3.0, kCeilingLoss = 1.0;

// One match of a floor or ceiling.
struct LevelVote {
  size_t match = 0;
  bool floor = true;
  double planned_z_m = 0;
  double error_m = 0;  // how much higher than planned it lies; mean over its points
  // Of a room's floor (ceiling), by points, summed over the rooms that it goes on through: a room has one vote, in however many pieces its
  // floor was seen, and a step in a room has little of it.
  double share = 1;
};

// In the order of the matches, those of walls left out. O(views * rooms).
[[nodiscard]] std::vector<LevelVote> LevelVotes(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches,
                                                const std::vector<Eigen::Isometry3d>& T_map_kf, const Eigen::Isometry3d& T_plan_map);

// By how much the plan's place is too high: the error that agrees with most of the others. Zero without votes. O(n^2).
[[nodiscard]] double ConsensusHeight(const std::vector<LevelVote>& votes, double sigma_m);

}  // namespace plumb::runtime
