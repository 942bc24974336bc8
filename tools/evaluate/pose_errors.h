// How far a trajectory lies from the truth: absolute errors in the plan frame, no alignment.
#pragma once

#include <cstddef>

#include "runtime/sources/recording.h"

namespace plumb::tools {

struct PoseErrors {
  size_t count = 0;                            // poses that have a truth
  size_t without_truth = 0;                    // poses outside the truth's span or in a gap of it
  double rmse_m = 0, mean_m = 0, max_m = 0;    // of the distance between the positions (ATE)
  double yaw_rmse_rad = 0, yaw_max_rad = 0;    // of the heading about +z, wrapped to [-pi, pi]
  double tilt_rmse_rad = 0, tilt_max_rad = 0;  // of roll and pitch together, as PoseDifference
};

// Distance of one pose to another, the turn about +z that best takes one orientation onto the other (least squares), and the angle
// between the two verticals: what is left of the rotation when its turn about +z is taken out.
struct PoseDifference {
  double distance_m = 0;
  double yaw_rad = 0;   // estimate minus truth, wrapped to [-pi, pi]
  double tilt_rad = 0;  // 0 to pi
};
[[nodiscard]] PoseDifference Difference(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth);

// At the estimate's stamps, against the truth interpolated there; no interpolation over gaps longer than `max_gap_s`. Linear times log.
[[nodiscard]] PoseErrors ComparePoses(const runtime::Trajectory& estimate, const runtime::Trajectory& truth, double max_gap_s);

}  // namespace plumb::tools
