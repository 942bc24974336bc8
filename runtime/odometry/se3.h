// The few operations on rigid motions that registration needs.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace plumb::runtime {

// Rotation by |w| about w.
[[nodiscard]] inline Eigen::Matrix3d ExpSo3(const Eigen::Vector3d& w) {
  const double angle_rad = w.norm();
  if (angle_rad < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle_rad, w / angle_rad).toRotationMatrix();
}

// The rotation vector of R, shorter than pi.
[[nodiscard]] inline Eigen::Vector3d LogSo3(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd a(R);
  return a.angle() * a.axis();
}

// The least rotation that turns one unit vector into another, which must not be its opposite.
[[nodiscard]] inline Eigen::Matrix3d LeastRotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d v = from.cross(to);
  Eigen::Matrix3d V;
  V << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return Eigen::Matrix3d::Identity() + V + V * V / (1 + from.dot(to));
}

// Linear in translation, constant angular rate in rotation; s outside [0, 1] extrapolates.
[[nodiscard]] inline Eigen::Isometry3d Interpolate(const Eigen::Isometry3d& T_0, const Eigen::Isometry3d& T_1, double s) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = T_0.linear() * ExpSo3(s * LogSo3(T_0.linear().transpose() * T_1.linear()));
  T.translation() = (1 - s) * T_0.translation() + s * T_1.translation();
  return T;
}

// T with the rotation's rounding errors removed.
[[nodiscard]] inline Eigen::Isometry3d Orthonormalized(const Eigen::Isometry3d& T) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  out.translation() = T.translation();
  return out;
}

}  // namespace plumb::runtime
