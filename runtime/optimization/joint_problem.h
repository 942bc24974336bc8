// The joint problem as the optimizer sees it: a state, priors that change between rounds, solve, covariances. Ceres stays in the .cc.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/coupling/wall_frame.h"
#include "runtime/optimization/joint_optimizer.h"
#include "runtime/optimization/residuals.h"

namespace plumb::runtime {

struct JointState {
  std::vector<std::array<double, kPoseSize>> poses;   // per keyframe
  std::array<double, kPlaceSize> place{};
  double bias_m = 0;
  std::vector<WallId> wall_ids;                       // matched walls, ascending
  std::vector<std::array<double, kNumWallParameters>> walls;
  std::vector<std::array<double, 1>> levels;          // per match of a floor or ceiling
  std::vector<std::array<double, kPlaneSize>> planes; // per unmatched surface seen from two keyframes or more
};

[[nodiscard]] Eigen::Isometry3d PoseOf(const std::array<double, kPoseSize>& pose);
[[nodiscard]] std::array<double, kPoseSize> PoseBlock(const Eigen::Isometry3d& T);
[[nodiscard]] Eigen::Isometry3d PlaceOf(const std::array<double, kPlaceSize>& place);
[[nodiscard]] std::vector<Eigen::Isometry3d> Poses(const JointState& state);  // T_map_kf per keyframe
[[nodiscard]] std::array<double, kPlaceSize> PlaceBlock(const Eigen::Isometry3d& T_plan_map);

struct JointCovariances {
  Eigen::Matrix4d place;                // x, y, z, yaw
  std::vector<Eigen::Matrix4d> walls;   // as JointState::walls
};

class JointProblem {
 public:
  // Keeps references to all arguments. Where the mode of `options` estimates no deviations, walls stay as the state has them. The state's
  // walls, levels and planes are sized and levels and planes set here.
  JointProblem(const SGraph& map, const AGraph& plan, const std::vector<WallFrame>& frames, const std::vector<Match>& matches,
               const JointOptions& options, JointState& state);
  ~JointProblem();

  // Inverse prior variances of (offset, yaw) of one wall.
  void SetWallPrior(size_t wall, const Eigen::Vector2d& information);

  struct Outcome {
    bool usable = false, converged = false;
    int iterations = 0;
    double cost = 0;
    std::string message;
  };
  Outcome Solve();

  // At the state's present values, all other variables marginalised. None if the problem is rank deficient.
  [[nodiscard]] std::optional<JointCovariances> Covariances() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumb::runtime
