#include "runtime/optimization/odometry_step.h"

namespace plumb::runtime {

OdometryResidual OdometryStep(const Keyframe& a, const Keyframe& b, const JointOptions& options) {
  OdometryResidual out;
  out.T_a_b = a.T_odom_kf.inverse() * b.T_odom_kf;
  const StepSigma sigma = options.odometry.Between(a, b);
  out.sigma_m = sigma.m;
  out.sigma_rad = sigma.rad;
  return out;
}

}  // namespace plumb::runtime
