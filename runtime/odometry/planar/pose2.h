// Rigid motions in the plane.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace plumb::runtime {

// To [-pi, pi].
[[nodiscard]] inline double WrapYaw(double angle_rad) { return std::remainder(angle_rad, 2 * std::numbers::pi); }

// x_a = Rz(yaw) x_b + t: of frame b in frame a.
struct Pose2 {
  Eigen::Vector2d t_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0;

  [[nodiscard]] Eigen::Matrix2d Rotation() const { return Eigen::Rotation2Dd(yaw_rad).toRotationMatrix(); }
  [[nodiscard]] Eigen::Vector2d operator*(const Eigen::Vector2d& p) const { return Rotation() * p + t_m; }
  [[nodiscard]] Pose2 operator*(const Pose2& other) const { return {Rotation() * other.t_m + t_m, WrapYaw(yaw_rad + other.yaw_rad)}; }
  [[nodiscard]] Pose2 Inverse() const { return {-(Rotation().transpose() * t_m), -yaw_rad}; }
};

// Of b in a, both given in one frame.
[[nodiscard]] inline Pose2 Between(const Pose2& a, const Pose2& b) { return a.Inverse() * b; }

// Counter-clockwise by a right angle.
[[nodiscard]] inline Eigen::Vector2d Perpendicular(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

// Covariance of (x, y, yaw) of T_a_c = T_a_b T_b_c, each covariance in its own motion's first frame, their errors independent.
[[nodiscard]] inline Eigen::Matrix3d ComposedCovariance(const Pose2& T_a_b, const Eigen::Matrix3d& a_b, const Pose2& T_b_c,
                                                        const Eigen::Matrix3d& b_c) {
  Eigen::Matrix3d first = Eigen::Matrix3d::Identity(), second = Eigen::Matrix3d::Identity();
  first.topRightCorner<2, 1>() = Perpendicular(T_a_b.Rotation() * T_b_c.t_m);
  second.topLeftCorner<2, 2>() = T_a_b.Rotation();
  return first * a_b * first.transpose() + second * b_c * second.transpose();
}

// Of T_b_a, in the axes of b, given that of T_a_b in the axes of a.
[[nodiscard]] inline Eigen::Matrix3d InverseCovariance(const Pose2& T_a_b, const Eigen::Matrix3d& covariance) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J.topLeftCorner<2, 2>() = T_a_b.Rotation().transpose();
  J.topRightCorner<2, 1>() = -Perpendicular(T_a_b.Rotation().transpose() * T_a_b.t_m);
  return J * covariance * J.transpose();
}

// A body's pose as a planar pose of its levelled frame: T = Lifted(pose) * leveling * height. `leveling` has no yaw.
struct LeveledPose {
  Pose2 pose;
  Eigen::Matrix3d leveling = Eigen::Matrix3d::Identity();  // body frame to levelled frame
  double z_m = 0;

  [[nodiscard]] Eigen::Isometry3d Lifted() const {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(pose.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() * leveling;
    T.translation() << pose.t_m, z_m;
    return T;
  }
};

}  // namespace plumb::runtime
