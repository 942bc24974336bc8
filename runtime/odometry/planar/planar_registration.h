// Registration of a planar scan to lines: Gauss-Newton on (x, y, yaw) and on what the motion during the sweep differs from the one taken
// out of it.
//
// Residual of a point p seen at fraction s of the sweep: r = n . (R(yaw) p' + t - m), p' = p + s (u + w z x p), (n, m) the line's normal
// and mean:
//   dr/dt = n, dr/dyaw = n . (z x R p'), dr/du = s R^T n, dr/dw = s n . R (z x p).
// Kernel: Geman-McClure, its scale halving down to three sigma. Directions that the lines do not hold stay where they start: where the
// search, which knows corners and clutter too, or else the prior has put them.
#pragma once

#include <Eigen/Core>

#include "runtime/odometry/planar/correlative_search.h"
#include "runtime/odometry/planar/line_map.h"
#include "runtime/odometry/registration.h"

namespace plumb::runtime {

struct PlanarRegistrationOptions {
  int max_iterations = 20;
  double sigma_m = 0.02;                // of a point about a line
  double initial_kernel_m = 0.2;
  double points_per_independent = 4;    // neighbouring returns err alike
  double sweep_sigma_m = 0, sweep_sigma_rad = 0;  // of the motion taken out of the sweep; 0: exact, as without times
};

struct PlanarRegistration {
  bool ok = false;  // enough points lie on the map's lines
  Pose2 pose;
  Pose2 sweep_correction;  // (u, w): to be added to the motion taken out of the sweep
  // Of (x, y, yaw) in the map's frame: what the points say alone, nothing in directions that the lines do not hold; and with the prior.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  int iterations = 0;
  int num_inliers = 0;
  double inlier_share = 0;  // of the points with a normal
  double rms_m = 0;         // of inliers
};

struct PointToLine {
  double residual_m = 0;
  Vector6d jacobian = Vector6d::Zero();  // by (x, y, yaw) of the pose and (u, w) of the correction
};
[[nodiscard]] PointToLine EvaluatePointToLine(const Pose2& pose, const Pose2& correction, const PlanarPoint& point,
                                              const Eigen::Vector2d& normal, const Eigen::Vector2d& mean);

// Starts at `start`, the search's result or the prior's mean; the prior counts for the covariance only. O(iterations * points).
[[nodiscard]] PlanarRegistration RegisterPlanar(const PlanarScan& scan, const LineMap& map, const Pose2& start, const PlanarPrior& prior,
                                                const PlanarRegistrationOptions& options);

}  // namespace plumb::runtime
