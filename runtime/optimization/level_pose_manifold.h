// Only for .cc files: includes Ceres.
#pragma once

#include <ceres/manifold.h>

#include <Eigen/Geometry>
#include <cmath>

#include "runtime/optimization/residuals.h"

namespace plumb::runtime {

// Poses that turn about z and move in x and y only: of a planar laser, which tells nothing else. Tangent: yaw, x, y.
class LevelPoseManifold final : public ceres::Manifold {
 public:
  [[nodiscard]] int AmbientSize() const override { return kPoseSize; }
  [[nodiscard]] int TangentSize() const override { return 3; }

  bool Plus(const double* x, const double* delta, double* out) const override {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(delta[0], Eigen::Vector3d::UnitZ()));
    Eigen::Map<Eigen::Quaterniond> turned(out);
    turned = turn * Eigen::Map<const Eigen::Quaterniond>(x);
    out[4] = x[4] + delta[1];
    out[5] = x[5] + delta[2];
    out[6] = x[6];
    return true;
  }
  bool PlusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, kPoseSize, 3, Eigen::RowMajor>> J(jacobian);
    J.setZero();
    J.col(0).head<4>() << -0.5 * x[1], 0.5 * x[0], 0.5 * x[3], -0.5 * x[2];  // (0, 0, 1/2, 0) * q
    J(4, 1) = J(5, 2) = 1;
    return true;
  }
  bool Minus(const double* y, const double* x, double* delta) const override {
    const Eigen::Quaterniond turn = Eigen::Map<const Eigen::Quaterniond>(y) * Eigen::Map<const Eigen::Quaterniond>(x).conjugate();
    delta[0] = 2 * std::atan(turn.z() / turn.w());  // the same for q and -q; a half turn is infinite and comes out as pi
    delta[1] = y[4] - x[4];
    delta[2] = y[5] - x[5];
    return true;
  }
  bool MinusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 3, kPoseSize, Eigen::RowMajor>> J(jacobian);
    J.setZero();
    J.row(0).head<4>() << -2 * x[1], 2 * x[0], 2 * x[3], -2 * x[2];
    J(1, 4) = J(2, 5) = 1;
    return true;
  }
};

}  // namespace plumb::runtime
