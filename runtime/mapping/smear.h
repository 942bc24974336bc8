// How far unknown motion within sweeps may have displaced what a keyframe saw: by direction, as a wall along the way is seen sharply and
// one across it is not.
#pragma once

#include <Eigen/Core>

namespace plumb::runtime {

// Second moments of the displacement and of the turn (axis times angle) about the keyframe, in the keyframe's axes; zero for timed points.
struct Smear {
  Eigen::Matrix3d m2 = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d rad2 = Eigen::Matrix3d::Zero();

  [[nodiscard]] Smear Rotated(const Eigen::Matrix3d& R) const { return {R * m2 * R.transpose(), R * rad2 * R.transpose()}; }
  // The least that is nowhere below itself or `other`.
  void Cover(const Smear& other);
  // Variance of where a plane with unit normal n is seen at point p; and of its normal's turn towards a direction, `axis` being what it
  // turns about.
  [[nodiscard]] double OffsetVariance_m2(const Eigen::Vector3d& n, const Eigen::Vector3d& p) const;
  [[nodiscard]] double TurnVariance_rad2(const Eigen::Vector3d& axis) const { return axis.dot(rad2 * axis); }
};

}  // namespace plumb::runtime
