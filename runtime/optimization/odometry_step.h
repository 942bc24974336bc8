// Odometry between two keyframes as the solvers see it.
#pragma once

#include "runtime/mapping/sgraph.h"
#include "runtime/optimization/joint_optimizer.h"
#include "runtime/optimization/residuals.h"

namespace plumb::runtime {

// How far off it may be grows with the way driven between the two, not only with how far apart they are.
[[nodiscard]] OdometryResidual OdometryStep(const Keyframe& a, const Keyframe& b, const JointOptions& options);

}  // namespace plumb::runtime
