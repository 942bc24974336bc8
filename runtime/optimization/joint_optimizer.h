// The diS-Graph's least squares (Ceres): keyframes, map surfaces, the plan's place, and how every wall deviates, in one problem.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/mapping/sgraph.h"
#include "schema/agraph.h"

namespace plumb::runtime {

struct JointOptions {
  double point_sigma_m = 0.03;         // range noise ...
  double correlation = 10.0;           // ... inflated by sqrt of this: points of one surface share their errors
  double odometry_sigma_m = 0.01;      // per keyframe step
  double odometry_sigma_rad = 0.003;
  double bias_sigma_m = 0.03;          // prior of the common range bias
  double thickness_sigma_m = 0.01;     // prior of a wall's thickness error
  int em_rounds = 4;
  int max_iterations = 30;
  CouplingOptions coupling;            // mixture prior
  [[nodiscard]] std::string Check() const;
};

// Estimate of one physical wall; the reference surface is the wall's lowest-id matched surface.
struct WallEstimate {
  WallId wall;
  SurfaceId reference;
  WallDeviation deviation;
  Eigen::Matrix2d cov = Eigen::Matrix2d::Zero();  // of (offset_m, yaw_rad), poses and transform marginalised
  double thickness_error_m = 0;                   // + thicker than planned
  double p_deviated = 0;                          // responsibility of the mixture's wide component
  double num_points = 0;
  double observed_m2 = 0;
};

struct JointResult {
  bool converged = false;
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d cov_xy_yaw = Eigen::Matrix3d::Zero();
  double range_bias_m = 0;
  std::vector<WallEstimate> walls;   // sorted by wall id
  std::vector<Eigen::Isometry3d> T_map_kf;  // per keyframe
  int iterations = 0;
  std::string message = "not run";
};

// Solves from `T_plan_map` and the map's current values. Deterministic.
[[nodiscard]] JointResult OptimizeJointly(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches,
                                          const Eigen::Isometry3d& T_plan_map, const JointOptions& options = {});

}  // namespace plumb::runtime
