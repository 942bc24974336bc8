#include "runtime/mapping/pose_motion.h"

#include <gtest/gtest.h>

#include "tests/support/jacobian.h"

namespace plumb::runtime {
namespace {

Eigen::Isometry3d Pose(double x, double y, double z, const Eigen::Vector3d& turn_rad) {
  Eigen::Isometry3d T(Eigen::Translation3d(x, y, z));
  T.linear() = ExpSo3(turn_rad);
  return T;
}

Eigen::Isometry3d Shifted(const Eigen::Isometry3d& T, const Vector6d& d) { return Moved(T, d, T.translation()); }

// Of function(T moved by d) against function(T), by d.
template <class F>
Matrix6d Derivative(const Eigen::Isometry3d& T, const F& function) {
  constexpr double kStep = 1e-6;
  Matrix6d J;
  for (int i = 0; i < 6; ++i) J.col(i) = Increment(function(T), function(Shifted(T, kStep * Vector6d::Unit(i)))) / kStep;
  return J;
}

const Eigen::Isometry3d kA = Pose(3, -1, 0.5, {0.1, -0.3, 0.8}), kB = Pose(-2, 4, 1, {-0.4, 0.2, 0.5});

Matrix6d SomeCovariance(double scale) {
  Matrix6d half = Matrix6d::Identity();
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < i; ++k) half(i, k) = 0.1 * (i - 2 * k);
  return scale * half * half.transpose();
}

TEST(PoseMotion, ComposedAndInverseCovariancesAreThoseOfTheDerivatives) {
  const Matrix6d a = SomeCovariance(1), b = SomeCovariance(0.3);
  const Matrix6d by_a = Derivative(kA, [](const auto&T) { return T * kB; }), by_b = Derivative(kB, [](const auto&T) { return kA * T; });
  EXPECT_LT((ComposedCovariance(kA, a, kB, b) - by_a * a * by_a.transpose() - by_b * b * by_b.transpose()).norm(), 1e-3);
  const Matrix6d inverse = Derivative(kA, [](const auto& T) { return T.inverse(); });
  EXPECT_LT((InverseCovariance(kA, a) - inverse * a * inverse.transpose()).norm(), 1e-3);
}

TEST(PoseMotion, ResidualIsTheIncrementOfTheMeasuredMotion) {
  const Eigen::Isometry3d in_body = Pose(0.2, 0.1, 0, {0, 0, 0.4}), measured = Pose(1, 2, 0.1, {0.02, 0, 0.3});
  const Vector6d off = (Vector6d() << 1e-4, -2e-4, 3e-4, 0.1, -0.2, 0.3).finished();
  const Eigen::Isometry3d b = kA * Shifted(measured, off) * in_body.inverse();
  const auto block = [](const Eigen::Isometry3d& T) {
    Eigen::Matrix<double, 7, 1> out;
    out << Eigen::Quaterniond(T.linear()).coeffs(), T.translation();
    return out;
  };
  const Eigen::Matrix<double, 7, 1> pose_a = block(kA), pose_b = block(b);
  Vector6d r;
  const MotionResidual residual{measured, 2 * Matrix6d::Identity(), Eigen::Isometry3d::Identity(), in_body};
  ASSERT_TRUE(residual(pose_a.data(), pose_b.data(), r.data()));
  EXPECT_LT((r - 2 * off).norm(), 1e-6);
}

TEST(PoseMotion, ResidualsHaveTheJacobiansOfDifferencesAndTellAllOfBothEnds) {
  const auto block = [](const Eigen::Isometry3d& T) {
    return (Eigen::Matrix<double, 7, 1>() << Eigen::Quaterniond(T.linear()).coeffs(), T.translation()).finished();
  };
  const MotionResidual residual{Pose(1, 2, 0.1, {0.02, 0, 0.3}), SomeCovariance(1), Pose(0, 0.3, 0, {0, 0.2, 0}),
                                Pose(0.2, 0.1, 0, {0, 0, 0.4})};
  Eigen::Matrix<double, 14, 1> x;
  x << block(kA), block(kB);
  const auto J = test::CheckedJacobian<6, 14>([&](const auto* p, auto* r) { residual(p, p + 7, r); }, x);
  EXPECT_EQ(test::Rank(J.leftCols<7>() * test::PoseTangent(x.head<7>())), 6);
  EXPECT_EQ(test::Rank(J.rightCols<7>() * test::PoseTangent(x.tail<7>())), 6);

  const PlanarMotionResidual planar{{{1, 0.2}, 0.5}, SomeCovariance(1).topLeftCorner<3, 3>()};
  const Eigen::Matrix<double, 6, 1> y = (Eigen::Matrix<double, 6, 1>() << 3, -1, 0.8, -2, 4, -2.9).finished();
  const auto by_ends = test::CheckedJacobian<3, 6>([&](const auto* p, auto* r) { planar(p, p + 3, r); }, y);
  EXPECT_EQ(test::Rank(by_ends.leftCols<3>()), 3);
  EXPECT_EQ(test::Rank(by_ends.rightCols<3>()), 3);
}

TEST(PoseMotion, PlanarResidualIsTheMotionLessWhatWasMeasured) {
  const Pose2 from{{1, 2}, 3.0}, measured{{0.5, -0.1}, 0.2}, to = from * measured;  // the heading passes pi
  const Eigen::Vector3d off(0.01, -0.02, 0.03);
  const Eigen::Vector2d shifted = from * Eigen::Vector2d(measured.t_m + off.head<2>());
  const double a[3] = {1, 2, 3.0}, b[3] = {shifted.x(), shifted.y(), to.yaw_rad + off.z()};
  Eigen::Vector3d r;
  const PlanarMotionResidual residual{measured, 2 * Eigen::Matrix3d::Identity()};
  ASSERT_TRUE(residual(a, b, r.data()));
  EXPECT_LT((r - 2 * off).norm(), 1e-9);
}

}  // namespace
}  // namespace plumb::runtime
