// What odometry expects of the next sweep before it looks at its points: the last motion goes on, or a given odometry tells how.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "runtime/odometry/odometry.h"
#include "runtime/odometry/registration.h"

namespace plumb::runtime {

struct Twist {
  Eigen::Vector3d v_mps = Eigen::Vector3d::Zero(), w_radps = Eigen::Vector3d::Zero();  // lidar frame
};

[[nodiscard]] Twist TwistBetween(const Eigen::Isometry3d& T_0, const Eigen::Isometry3d& T_1, double dt_s);

// T after dt_s of a motion. With `up`, climbing dies out.
[[nodiscard]] Eigen::Isometry3d Advanced(const Eigen::Isometry3d& T, const Twist& twist, double dt_s,
                                         const std::optional<Eigen::Vector3d>& up);

[[nodiscard]] inline double RotationAngle(const Eigen::Isometry3d& T) { return LogSo3(T.linear()).norm(); }

// The last sweep, as estimated.
struct EstimatedSweep {
  double stamp_s = 0, sweep_s = 0;
  SweepMotion motion;
  Matrix12d covariance = Matrix12d::Zero();  // of `motion`'s start and motion during the sweep
  Twist twist;
  std::optional<Odometry::GivenMotion> given;
  // From its end to the next stamp; negative if sweeps overlap.
  [[nodiscard]] double GapTo_s(double next_stamp_s) const;
};

// Given odometry: its step, to a tenth. Without: constant velocity, whose change is that of a robot or a walking person. O(1).
[[nodiscard]] SweepGaussian PredictSweep(const EstimatedSweep& last, double next_stamp_s, double next_sweep_s,
                                         const std::optional<Odometry::GivenMotion>& given, const std::optional<Eigen::Vector3d>& up);

}  // namespace plumb::runtime
