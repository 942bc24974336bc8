// Where the plan lies, from wall-level measurements alone: closed form with exhaustive consensus, so that deviated walls do not drag it.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "runtime/optimization/wall_measurement.h"

namespace plumb::runtime {

struct PlaceSeed {
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();
  double bias_m = 0;
};

// Every pair of non-parallel walls proposes a place in which both stand as planned; the best by truncated cost are polished by EM with a
// shrinking tolerance, and the one with the least -log p under the deviation mixture wins. The given place is kept unless another is
// better by a nat. One vote per physical wall. O(n^3) for n <= 60 walls, O(n) beyond.
[[nodiscard]] PlaceSeed SeedPlace(const std::vector<WallMeasurement>& walls, const std::vector<WallFrame>& frames,
                                  const Eigen::Isometry3d& T_plan_map, const JointOptions& options);

// Another place that the walls leave possible, and what they would then be measured as.
struct RivalPlace {
  double log_odds = 0;                  // against the given place, under the deviation mixture
  std::vector<Eigen::Vector2d> shifts;  // of each wall's measured (offset_m, yaw_rad), as `walls`
};

// The polished proposals of SeedPlace() at which some wall's offset differs by 2 cm and more from that at `T_plan_map`, the estimate, and
// which are less probable by 7 nats at most. One that differs in what no wall tells, as along a corridor, is the same place. O() as
// SeedPlace().
[[nodiscard]] std::vector<RivalPlace> RivalPlaces(const std::vector<WallMeasurement>& walls, const std::vector<WallFrame>& frames,
                                                  const Eigen::Isometry3d& T_plan_map, const JointOptions& options);

// Per axis of wall normals: walls that agree on the frame and the largest group that agrees on another.
[[nodiscard]] std::vector<DirectionSupport> SupportByDirection(const std::vector<WallMeasurement>& walls,
                                                               const std::vector<WallFrame>& frames, double bias_m,
                                                               const CouplingOptions& options);

}  // namespace plumb::runtime
