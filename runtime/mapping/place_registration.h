// Where a keyframe stands by what was seen about an older one.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/odometry/registration.h"

namespace plumb::runtime {

struct PlaceRegistrationOptions {
  double range_sigma_m = 0.02;            // noise of a single return
  double submap_way_m = 2.5;              // either side of the older keyframe along the robot's way
  double keyframe_spacing_m = 0.5;        // of the keyframes there that are used
  double basin_m = 0.5, basin_rad = 0.3;  // registration finds home from so far off; more starts are tried if it may be farther
  // Three times the registration's own: what leans on 0.3 % of the planes may be clutter.
  double degenerate_ratio = 1e-3;
};

struct PlaceRegistration {
  bool ok = false;  // enough points lie on the place's planes
  Eigen::Isometry3d T_place_kf = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  // of its increment (pose_motion.h) by the points alone
  int num_held = 0;                         // directions that the points hold
  int num_inliers = 0;
  double inlier_ratio = 0, overlap_ratio = 0;  // inliers of the points that meet a surface; those of all
};

// Point-to-plane registration of the points of `keyframe` on those about `place`, neither of them merged, started where the map has it
// and, as far as `covariance` (of its increment in `place`) makes it necessary, around there. Keyframes of less than half of
// `min_way_m` before `keyframe` are left out. Directions that the points do not hold stay at the start. 10 to 40 ms.
[[nodiscard]] PlaceRegistration RegisterToPlace(const std::vector<Keyframe>& keyframes, uint32_t place, uint32_t keyframe,
                                                const Matrix6d& covariance, double min_way_m, const PlaceRegistrationOptions& options);

}  // namespace plumb::runtime
