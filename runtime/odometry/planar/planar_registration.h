// Registration of a planar scan to lines: Gauss-Newton on (x, y, yaw).
//
// Residual of a point p: r = n . (R(yaw) p + t - m), (n, m) the line's normal and mean; dr/dt = n, dr/dyaw = n . (z x R p).
// Kernel: Geman-McClure, its scale halving down to three sigma. Directions that the lines do not hold stay where they start: where the search,
// which knows corners and clutter too, or else the prior has put them.
#pragma once

#include <Eigen/Core>

#include "runtime/odometry/planar/correlative_search.h"
#include "runtime/odometry/planar/line_map.h"

namespace plumb::runtime {

struct PlanarRegistrationOptions {
  int max_iterations = 20;
  double sigma_m = 0.02;                // of a point about a line
  double initial_kernel_m = 0.2;
  double points_per_independent = 4;    // neighbouring returns err alike
};

struct PlanarRegistration {
  bool ok = false;  // enough points lie on the map's lines
  Pose2 pose;
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
  Eigen::Vector3d jacobian = Eigen::Vector3d::Zero();  // by (x, y, yaw)
};
[[nodiscard]] PointToLine EvaluatePointToLine(const Pose2& pose, const Eigen::Vector2d& p, const Eigen::Vector2d& normal, const Eigen::Vector2d& mean);

// Starts at `start`, the search's result or the prior's mean; the prior counts for the covariance only. O(iterations * points).
[[nodiscard]] PlanarRegistration RegisterPlanar(const PlanarScan& scan, const LineMap& map, const Pose2& start, const PlanarPrior& prior,
                                                const PlanarRegistrationOptions& options);

}  // namespace plumb::runtime
