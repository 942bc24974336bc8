#include "runtime/odometry/level_motion.h"

#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr double kAxisFade = 1.0 / 600, kSwayFade = 1.0 / 30;  // per sweep
constexpr double kFirstUpSweeps = 20;                   // that the given direction counts as
constexpr double kAttitudeNoise_rad = 0.002;            // of a sweep's tilt, besides its covariance, ...
constexpr double kNoiseSigmas = 2;                      // ... of which so many are no sway
constexpr double kUnevenness_mps = 0.002;               // of level floors, thresholds and joints, as wheels pass them
constexpr double kLever_m = 0.1;                        // what sways moves up and down by that even if it goes nowhere

}  // namespace

// The axis t in odometry's frame and b in the lidar's make sum |R^T t - b|^2 + k |t - first_up|^2 least: a step of alternating minimization
// per sweep.
void LevelMotion::Learn(const Eigen::Isometry3d& T_odom_lidar, const Eigen::Matrix3d& rotation_covariance) {
  const Eigen::Matrix3d R = T_odom_lidar.linear();
  rotations_ += R - kAxisFade * rotations_;
  up_in_lidar_ = (rotations_.transpose() * up_).normalized();
  up_ = (rotations_ * up_in_lidar_ + kFirstUpSweeps * first_up_).normalized();
  const double noise2_rad2 = rotation_covariance.trace() - up_.dot(rotation_covariance * up_) + kAttitudeNoise_rad * kAttitudeNoise_rad;
  const double off2_rad2 = std::max(0.0, (R.transpose() * up_ - up_in_lidar_).squaredNorm() - kNoiseSigmas * kNoiseSigmas * noise2_rad2);
  sway2_rad2_ = std::max(off2_rad2, sway2_rad2_ + kSwayFade * (off2_rad2 - sway2_rad2_));
}

double LevelMotion::sway_rad() const { return std::sqrt(sway2_rad2_); }

SweepGaussian LevelMotion::Restrict(const SweepGaussian& free, const EstimatedSweep& last, double next_stamp_s, double next_sweep_s) const {
  const double gap_s = last.GapTo_s(next_stamp_s), speed_mps = last.twist.v_mps.norm();
  const auto variance_m2 = [&](double dt_s) {
    const double sigma_m = std::abs(dt_s) * (kUnevenness_mps + speed_mps * sway_rad()) + kLever_m * sway_rad();
    return sigma_m * sigma_m + 1e-10;
  };
  Vector12d start = Vector12d::Zero(), motion = Vector12d::Zero();
  start.segment<3>(3) = motion.tail<3>() = up_;
  const Vector12d end = start + motion;
  const Matrix12d level = Matrix12d::Identity() - start * start.transpose() - motion * motion.transpose();
  SweepGaussian out = free;
  out.covariance = level * free.covariance * level;
  out.covariance += (end.dot(last.covariance * end) + variance_m2(gap_s)) * start * start.transpose() +
                    variance_m2(next_sweep_s) * motion * motion.transpose();
  for (Eigen::Isometry3d* T : {&out.mean.T_start, &out.mean.T_end})
    T->translation() += up_.dot(last.motion.T_end.translation() - T->translation()) * up_;
  return out;
}

}  // namespace plumb::runtime
