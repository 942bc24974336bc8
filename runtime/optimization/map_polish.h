// The S-Graph by itself, without a plan: plane bundle adjustment over the whole run (runtime/METHOD.md, plane bundle adjustment).
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/optimization/joint_optimizer.h"

namespace plumb::runtime {

struct PolishResult {
  bool usable = false;                      // false: the solver failed, the poses are as they were
  bool converged = false;                   // else they are better than before, but iterations ran out
  std::vector<Eigen::Isometry3d> T_map_kf;  // per keyframe
  int iterations = 0;
  std::string message = "not run";
};

// The joint problem's, but for two: what clings to a surface's edge is in all views of it and moves no keyframe against another, so it
// costs them no weight (edge_m2 = 0); and without a plan only the views themselves tell which of them is mistaken (observation_loss = 1),
// which takes more iterations.
[[nodiscard]] JointOptions PolishOptions();

// Moves all keyframes so that every surface is as thin as its views allow: each view is a pi-factor on a plane that is free, consecutive
// keyframes are tied by odometry as loosely as it drifts. The first keyframe stays. Of `options` only the views, the odometry, gravity and
// the iterations count. Mapper::OnPosesChanged() takes the poses over. 400 keyframes: about half a second.
[[nodiscard]] PolishResult PolishMap(const SGraph& map, const JointOptions& options = PolishOptions());

}  // namespace plumb::runtime
