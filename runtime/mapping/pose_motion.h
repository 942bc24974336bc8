// Rigid motions as measurements: their covariances, and how two poses disagree with one.
//
// The error of a motion T_a_b is an increment (rotation, translation) in the axes of a, about b: R = Exp(dr) R', t = t' + dt. These are
// the increments of registration (registration.h).
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "runtime/odometry/planar/pose2.h"
#include "runtime/odometry/registration.h"

namespace plumb::runtime {

[[nodiscard]] inline Eigen::Matrix3d Cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// Of b in a, both given in one frame.
[[nodiscard]] inline Eigen::Isometry3d Between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) { return a.inverse() * b; }

// Covariance of T_a_c = T_a_b T_b_c, their errors independent.
[[nodiscard]] inline Matrix6d ComposedCovariance(const Eigen::Isometry3d& T_a_b, const Matrix6d& a_b, const Eigen::Isometry3d& T_b_c,
                                                 const Matrix6d& b_c) {
  Matrix6d first = Matrix6d::Identity(), second = Matrix6d::Zero();
  first.bottomLeftCorner<3, 3>() = -Cross(T_a_b.linear() * T_b_c.translation());
  second.topLeftCorner<3, 3>() = second.bottomRightCorner<3, 3>() = T_a_b.linear();
  return first * a_b * first.transpose() + second * b_c * second.transpose();
}

// Of T_b_a, given that of T_a_b.
[[nodiscard]] inline Matrix6d InverseCovariance(const Eigen::Isometry3d& T_a_b, const Matrix6d& covariance) {
  const Eigen::Matrix3d R = T_a_b.linear().transpose();
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = J.bottomRightCorner<3, 3>() = -R;
  J.bottomLeftCorner<3, 3>() = -R * Cross(T_a_b.translation());
  return J * covariance * J.transpose();
}

// The increment that turns `from` into `to`.
[[nodiscard]] inline Vector6d Increment(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  Vector6d d;
  d << LogSo3(to.linear() * from.linear().transpose()), to.translation() - from.translation();
  return d;
}

// The increment between a measured motion and that of two poses, whitened. Poses are [qx qy qz qw tx ty tz] of bodies that carry the two
// keyframes along. Templated on the scalar so that Ceres differentiates it.
struct MotionResidual {
  Eigen::Isometry3d T_from_to;  // as measured
  Matrix6d sqrt_information;
  Eigen::Isometry3d T_a_from = Eigen::Isometry3d::Identity(), T_b_to = Eigen::Isometry3d::Identity();  // of the keyframes in the bodies
  template <class T>
  bool operator()(const T* pose_a, const T* pose_b, T* r) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    using Rotation = Eigen::Quaternion<T>;
    const Eigen::Map<const Rotation> q_a(pose_a), q_b(pose_b);
    const Eigen::Map<const Vector> t_a(pose_a + 4), t_b(pose_b + 4);
    const Rotation q_from = q_a * Eigen::Quaterniond(T_a_from.linear()).cast<T>();
    const Rotation q_to = q_b * Eigen::Quaterniond(T_b_to.linear()).cast<T>();
    const Vector t_from = t_a + q_a * Vector(T_a_from.translation().cast<T>()), t_to = t_b + q_b * Vector(T_b_to.translation().cast<T>());
    const Rotation turn = q_from.conjugate() * q_to * Eigen::Quaterniond(T_from_to.linear()).conjugate().cast<T>();
    const T sign = turn.w() < T(0) ? T(-1) : T(1);  // q and -q turn alike
    Eigen::Matrix<T, 6, 1> off;
    off << sign * T(2) * turn.vec(), q_from.conjugate() * (t_to - t_from) - T_from_to.translation().cast<T>();
    Eigen::Map<Eigen::Matrix<T, 6, 1>> out(r);
    out = sqrt_information.cast<T>() * off;
    return true;
  }
};

// The same in the plane. Poses are [x y yaw].
struct PlanarMotionResidual {
  Pose2 T_from_to;                   // as measured
  Eigen::Matrix3d sqrt_information;  // of (x, y, yaw), in the axes of `from`
  template <class T>
  bool operator()(const T* from, const T* to, T* r) const {
    using std::cos;
    using std::floor;
    using std::sin;
    const T c = cos(from[2]), s = sin(from[2]), dx = to[0] - from[0], dy = to[1] - from[1];
    T turn = to[2] - from[2] - T(T_from_to.yaw_rad);
    turn = turn - T(2 * std::numbers::pi) * floor((turn + T(std::numbers::pi)) / T(2 * std::numbers::pi));
    const Eigen::Matrix<T, 3, 1> off(c * dx + s * dy - T(T_from_to.t_m.x()), c * dy - s * dx - T(T_from_to.t_m.y()), turn);
    Eigen::Map<Eigen::Matrix<T, 3, 1>> out(r);
    out = sqrt_information.cast<T>() * off;
    return true;
  }
};

}  // namespace plumb::runtime
