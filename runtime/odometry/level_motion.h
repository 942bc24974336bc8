// Robots stay at their height, as far as they do not tilt (runtime/METHOD.md, level motion).
#pragma once

#include <Eigen/Geometry>

#include "runtime/odometry/motion_prediction.h"

namespace plumb::runtime {

// How much this sensor sways about the axis that it turns about, learned from its own attitude, which walls show where nothing shows its
// height: what rolls on a level floor keeps its tilt, what climbs a ramp or stairs, walks or is carried does not.
class LevelMotion {
 public:
  // Direction away from gravity in odometry's frame, roughly: the axis is learned, too.
  explicit LevelMotion(const Eigen::Vector3d& up) : first_up_(up), up_(up) {}

  // As in the constructor, better known now; what was learned of the sway stays.
  void SetUp(const Eigen::Vector3d& up) { first_up_ = up_ = up; }

  // After each sweep that was registered, with the covariance of its pose (registration.h). O(1).
  void Learn(const Eigen::Isometry3d& T_odom_lidar, const Eigen::Matrix3d& rotation_covariance);

  // `free`, but along up() the robot stays where it was at the end of `last`, give or take what it sways.
  [[nodiscard]] SweepGaussian Restrict(const SweepGaussian& free, const EstimatedSweep& last, double next_stamp_s,
                                       double next_sweep_s) const;

  [[nodiscard]] double sway_rad() const;  // rms, what the attitude's noise makes up taken off
  [[nodiscard]] const Eigen::Vector3d& up() const { return up_; }

 private:
  Eigen::Vector3d first_up_, up_;
  Eigen::Vector3d up_in_lidar_ = Eigen::Vector3d::Zero();  // unit once learned
  Eigen::Matrix3d rotations_ = Eigen::Matrix3d::Zero();    // sum of R_odom_lidar, fading
  double sway2_rad2_ = 0;
};

}  // namespace plumb::runtime
