// The diS-Graph's least squares (Ceres): keyframes, map surfaces, the plan's place, and how every wall deviates, in one problem.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/mapping/odometry_drift.h"
#include "runtime/mapping/sgraph.h"
#include "runtime/optimization/estimation_mode.h"
#include "runtime/optimization/wall_posterior.h"
#include "schema/agraph.h"

namespace plumb::runtime {

struct JointOptions {
  EstimationMode mode = EstimationMode::kDis;
  double point_sigma_m = 0.03;           // range noise ...
  double correlation = 10.0;             // ... inflated by sqrt of this: points of one surface share their errors
  double observation_floor_m = 0.005;    // what one keyframe's view of a surface is good for, however many points it has: offset ...
  double observation_floor_rad = 0.003;  // ... and direction
  double edge_m2 = 0.002;                // what clings to a surface's edge, height times width (2 cm by 10 cm): it turns short views
  double observation_loss = 3.0;         // Cauchy scale of a view, in sigmas: a wrong association loses its grip beyond
  OdometryDrift odometry;
  double gravity_sigma_rad = 0.0087;        // roll and pitch of the first keyframe
  double bias_sigma_m = 0.02;               // prior of the common range bias
  double thickness_sigma_m = 0.01;          // prior of a wall's thickness error
  double tilt_sigma_rad = 0.003;            // prior of a wall's tilt
  double level_sigma_m = 0.015;             // prior of a floor's or ceiling's height error
  std::optional<Eigen::Isometry3d> place;   // T_plan_map as known before the walls are asked; none: the given one ...
  double place_sigma_m = 1.0;               // ... and how well
  int em_rounds = 4;                        // of at least one; stops early when responsibilities settle
  int max_iterations = 30;                  // per round
  bool fit_tolerance = true;                // with covariances: one more solve, with the tolerance that the walls show (built_tolerance.h)
  bool covariances = true;                  // off: WallEstimate::cov and cov_xy_yaw are conservative constants, and the call is faster
  CouplingOptions coupling;                 // mixture prior
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

// How much of one plan surface was seen.
struct SeenSurface {
  SurfaceId surface;
  double num_points = 0;
  double observed_m2 = 0;
};

// Estimate of one physical wall. The deviation is that of the wall's middle plane and refers to the wall's reference surface (wall_frame.h:
// its longest straight surface); a face stands off by it plus half the thickness error.
struct WallEstimate {
  WallId wall;
  SurfaceId reference;
  WallDeviation deviation;
  // Of (offset_m, yaw_rad), poses and place marginalised. Two standard deviations cover the truth with 95 %, whichever component of the
  // prior the wall belongs to and whichever of the places that the walls leave possible is the right one.
  Eigen::Matrix2d cov = Eigen::Matrix2d::Zero();
  WallEvidence evidence;                              // (offset_m, yaw_rad) as the data alone have it, at the estimated place
  double place_sigma_m = 0;                           // how far other possible places would shift the offset, rms
  double tilt_rad = 0;                                // + the reference normal turns upwards
  double thickness_error_m = 0;                       // + thicker than planned
  Eigen::Matrix4d cov_all = Eigen::Matrix4d::Zero();  // of (offset, yaw, tilt, thickness error)
  double p_deviated = 0;                              // that the wall belongs to the mixture's wide components
  double num_points = 0;                              // over all its faces
  double observed_m2 = 0;
  double span_m = 0;              // along the wall, from the first to the last that was seen of any face, ...
  double seen_m = 0;              // ... and what was seen of that, in steps of 10 cm
  std::vector<SeenSurface> seen;  // by surface id
};

// How well the walls that face along one line agree on where the plan lies along it.
struct DirectionSupport {
  double axis_rad = 0;   // of the normals, in [0, pi)
  int consistent = 0;    // walls that stand as planned in the chosen frame
  int next_cluster = 0;  // the most other walls that would, were the plan shifted along the axis
  [[nodiscard]] int margin() const { return consistent - next_cluster; }
  // One wall decides where the plan lies along this axis: were it the one that deviates, the estimate would not show it.
  [[nodiscard]] bool ambiguous() const { return margin() <= 1; }
};

struct JointResult {
  bool converged = false;
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d cov_xy_yaw = Eigen::Matrix3d::Zero();
  double range_bias_m = 0;                   // every wall is seen this far inside its free space
  std::vector<WallEstimate> walls;           // sorted by wall id
  std::vector<DirectionSupport> directions;  // by axis
  std::vector<Eigen::Isometry3d> T_map_kf;   // per keyframe; also turns the whole map a little if it was not level
  bool covariances_exact = false;            // false: rank deficient or not asked for; covariances are conservative
  std::string gauge;                         // how the frame was chosen, and whether another choice is as good
  int iterations = 0;
  int em_rounds = 0;
  double cost = 0;
  std::string message = "not run";

  // Per plan wall, as MatchSurfaces wants it; zero for walls that were not seen.
  [[nodiscard]] std::vector<WallDeviation> Deviations(size_t num_walls) const;
};

// Solves from `T_plan_map` (upright: yaw and translation) and the map's current poses; writing T_map_kf and T_plan_map back makes the next
// call a warm start. The plan's place is re-seeded from wall-level measurements each time, so that an early wrong choice of which walls
// deviate is undone once more walls speak against it; `T_plan_map` is kept in a tie. `options.mode` leaves out parts of this.
// Deterministic. 200 keyframes, 60 surfaces, 1000 observations: about 0.1 s on one core.
[[nodiscard]] JointResult OptimizeJointly(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches,
                                          const Eigen::Isometry3d& T_plan_map, const JointOptions& options = {});

}  // namespace plumb::runtime
