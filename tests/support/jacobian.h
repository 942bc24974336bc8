// Jacobians of residuals, as Ceres' own scalar has them and by differences.
#pragma once

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace plumb::test {

// By central differences. `call(parameters, residuals)`.
template <int kResiduals, int kParameters, class Call>
Eigen::Matrix<double, kResiduals, kParameters> NumericJacobian(const Call& call, const Eigen::Matrix<double, kParameters, 1>& x) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix<double, kResiduals, kParameters> J;
  for (int i = 0; i < kParameters; ++i) {
    const Eigen::Matrix<double, kParameters, 1> step = kStep * Eigen::Matrix<double, kParameters, 1>::Unit(i), hi = x + step, lo = x - step;
    Eigen::Matrix<double, kResiduals, 1> at_hi, at_lo;
    call(hi.data(), at_hi.data());
    call(lo.data(), at_lo.data());
    J.col(i) = (at_hi - at_lo) / (2 * kStep);
  }
  return J;
}

// Expects the one by automatic differentiation to be the one by differences, and returns it.
template <int kResiduals, int kParameters, class Call>
Eigen::Matrix<double, kResiduals, kParameters> CheckedJacobian(const Call& call, const Eigen::Matrix<double, kParameters, 1>& x) {
  using Jet = ceres::Jet<double, kParameters>;
  std::array<Jet, kParameters> jets;
  for (int i = 0; i < kParameters; ++i) jets[static_cast<size_t>(i)] = Jet(x[i], i);
  std::array<Jet, kResiduals> r;
  call(jets.data(), r.data());
  const Eigen::Matrix<double, kResiduals, kParameters> numeric = NumericJacobian<kResiduals, kParameters>(call, x);
  Eigen::Matrix<double, kResiduals, kParameters> automatic;
  for (int k = 0; k < kResiduals; ++k) {
    automatic.row(k) = r[static_cast<size_t>(k)].v.transpose();
    for (int i = 0; i < kParameters; ++i) {
      EXPECT_NEAR(automatic(k, i), numeric(k, i), 1e-4 * std::max(1.0, std::abs(numeric(k, i)))) << "residual " << k << " parameter " << i;
    }
  }
  return automatic;
}

// Of [qx qy qz qw tx ty tz] by an increment (rotation about the body in the outer frame's axes, translation).
inline Eigen::Matrix<double, 7, 6> PoseTangent(const Eigen::Matrix<double, 7, 1>& pose) {
  Eigen::Matrix<double, 7, 6> out = Eigen::Matrix<double, 7, 6>::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Quaterniond half(0, i == 0 ? 0.5 : 0, i == 1 ? 0.5 : 0, i == 2 ? 0.5 : 0);
    out.col(i).head<4>() = (half * Eigen::Quaterniond(pose.data())).coeffs();
    out(4 + i, 3 + i) = 1;
  }
  return out;
}

// Directions that change by less than a millionth of the largest count as none.
inline Eigen::Index Rank(const Eigen::MatrixXd& m) {
  Eigen::FullPivLU<Eigen::MatrixXd> lu(m);
  lu.setThreshold(1e-6);
  return lu.rank();
}

}  // namespace plumb::test
