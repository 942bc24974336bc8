// Registration of one sweep to a surfel map: Gauss-Newton on the poses at the sweep's start and end together.
//
// Residual of a point fired at fraction s of the sweep: r = n . (T(s) p - m), T(s) between the two poses, (n, m) the surfel's plane.
// Increments are taken in the odometry's frame about a centre c: T_start turns by d_r and moves by d_t, T_end by d + e; T(s) then by d + s
// e:
//   dr/d(d) = a = [(q - c) x n, n],   dr/d(e) = s a,   q = T(s) p.
// Kernel: Geman-McClure, its scale shrinking from what the prediction may be off to the noise.
// Directions that the planes do not hold (a corridor's length) are left to the prior.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "runtime/odometry/scan_preparation.h"
#include "runtime/odometry/surfel_map.h"

namespace plumb::runtime {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

// Gaussian on the increments (d, e) about `mean`: of the pose at the start and of the motion during the sweep.
struct SweepGaussian {
  SweepMotion mean;
  Matrix12d covariance = Matrix12d::Identity();
};

struct SweepPrior : SweepGaussian {
  // Of a robot that stays at its height along `up`: counts instead where the planes say little of the height.
  std::optional<SweepGaussian> level;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

  // Expects `motion` instead; level motion at the height that it has.
  void MoveTo(const SweepMotion& motion);
};

struct RegistrationOptions {
  int max_iterations = 20;
  double range_sigma_m = 0.02;
  double points_per_independent = 20;   // neighbouring returns err alike: so many count as one against the prior
  // A direction is the prior's alone if its share of the planes' information is below this, or below what the noise of their normals makes
  // up: along a smooth corridor, normals that err by 1 degree seem to say where the robot is.
  double degenerate_ratio = 3e-4;
  double level_ratio = 0.01;  // SweepPrior::level counts where the height along `up` has less than this share of the planes' information
  double initial_kernel_m = 0.3;        // of the first iteration; halves down to three sigma
  bool search_neighbours = false;       // first iterations also look into neighbouring voxels: for large prediction errors
};

struct RegistrationResult {
  bool ok = false;        // enough points lie on the map's planes
  SweepMotion motion;
  Matrix12d covariance = Matrix12d::Identity();  // of (d, e) about `motion`, prior and points together
  // Of d by the points alone, which hold `num_held` of its six directions; nothing along the others.
  Matrix6d information = Matrix6d::Zero();
  int num_held = 0;
  int iterations = 0;
  int num_inliers = 0;
  double inlier_ratio = 0;  // of the points that fell on a surfel
  double overlap_ratio = 0; // points that fell on a surfel, of all
  double rms_m = 0;
};

// Signed distance of T p to the plane through `mean` with `normal`, and its derivative by an increment (rotation, translation) about
// `center`.
struct PointToPlane {
  double residual_m = 0;
  Vector6d jacobian = Vector6d::Zero();
};
[[nodiscard]] PointToPlane EvaluatePointToPlane(const Eigen::Vector3d& q, const Eigen::Vector3d& normal, const Eigen::Vector3d& mean,
                                                const Eigen::Vector3d& center);

// T after an increment (rotation, translation) in the frame it maps to, turning about `center`.
[[nodiscard]] Eigen::Isometry3d Moved(const Eigen::Isometry3d& T, const Vector6d& increment, const Eigen::Vector3d& center);

// O(iterations * points).
[[nodiscard]] RegistrationResult RegisterSweep(std::span<const SweepPoint> points, bool timed, const SurfelMap& map,
                                               const SweepPrior& prior, const RegistrationOptions& options);

}  // namespace plumb::runtime
