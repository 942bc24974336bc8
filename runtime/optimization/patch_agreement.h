// Whether what was seen of a wall agrees with itself.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <vector>

#include "runtime/optimization/wall_measurement.h"

namespace plumb::runtime {

// Of a wall that several patches of the map were matched to and that contradict each other: a patch that leans across a step, or furniture
// taken for the wall, would make it sure of what is not so.
struct PatchDisagreement {
  // By how much larger the wall's variances are than its patches' own say (Birge's ratio, squared): chi-square of the patches' deviations
  // about their weighted mean by its degrees of freedom.
  double variance_ratio = 1;
  // Of all that were asked, (offset_m, yaw_rad), if the ratio is above 1: the solve settles on one of them instead.
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  // To be added to the variances. Where the solve has let go of more than a third of what was seen of the wall: mean over all of that, by
  // area, of the square of how far off it is, what the solve has kept counting as not off at all. Where patches that are a third or less
  // contradict the rest, which agrees: the square of how far the solve is off that.
  Eigen::Matrix2d added = Eigen::Matrix2d::Zero();
};

// By wall; walls whose patches agree (chi-square, 99 %) are left out. `estimates`: (offset_m, yaw_rad, thickness error in m) of every wall
// that has matches. Patches so far from it that the solve's loss has let go of them (a tenth of their weight) are not asked: they are one
// odd thing or two, unless they are much of the wall. Other arguments as MeasureWalls(); O(views).
[[nodiscard]] std::map<WallId, PatchDisagreement> FindDisagreements(const SGraph& map, const AGraph& plan,
                                                                    const std::vector<WallFrame>& frames, const std::vector<Match>& matches,
                                                                    const std::vector<Eigen::Isometry3d>& T_map_kf,
                                                                    const Eigen::Isometry3d& T_plan_map,
                                                                    const std::map<WallId, Eigen::Vector3d>& estimates, double bias_m,
                                                                    const JointOptions& options);

}  // namespace plumb::runtime
