#include "runtime/mapping/view_equations.h"

#include <gtest/gtest.h>

#include "tests/support/jacobian.h"

namespace plumb::runtime {
namespace {

PlaneView SomeView() {
  PlaneStats stats;
  for (int i = 0; i < 40; ++i) {
    const double a = i % 8 - 3.5, b = i / 8 - 2.0;
    stats.Add({3 + 0.1 * b, 0.5 * a, 0.4 * b + 0.02 * (i % 3)});
  }
  return {stats, {}};
}

const Plane kPlane{Eigen::Vector3d(-0.9, 0.3, 0.1).normalized(), 2.4};
const Eigen::Vector3d kAt = -2.4 * kPlane.n + 0.7 * kPlane.n.unitOrthogonal();
const Eigen::Isometry3d kPose = Eigen::Translation3d(0.3, -0.2, 0.1) * Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 5).normalized());

// The residual itself, of the plane and the pose moved by what the equations are linear in.
Eigen::Vector3d ResidualAt(const PlaneView& view, const Eigen::Matrix<double, 9, 1>& x) {
  const Eigen::Vector3d a = kPlane.n.unitOrthogonal(), b = kPlane.n.cross(a);
  const Eigen::Vector3d n = (kPlane.n + x[0] * a + x[1] * b).normalized();
  const double d = -n.dot(kAt) + kPlane.SignedDistance(kAt) + x[2];
  const Eigen::Isometry3d T = Moved(kPose, x.tail<6>(), kPose.translation());
  Eigen::Vector3d r;
  view.Residual<double>(T.linear().transpose() * n, d + n.dot(T.translation()), r.data());
  return r;
}

TEST(ViewEquations, AreTheDerivativesOfTheViewsResidual) {
  const PlaneView view = SomeView();
  const ViewEquations e = EquationsOf(view, kPose, kPlane, kAt);
  const auto residual = [&](const double* x, double* r) {
    Eigen::Map<Eigen::Vector3d> out(r);
    out = ResidualAt(view, Eigen::Map<const Eigen::Matrix<double, 9, 1>>(x));
  };
  EXPECT_LT((e.residual - ResidualAt(view, Eigen::Matrix<double, 9, 1>::Zero())).norm(), 1e-9);
  const auto J = test::NumericJacobian<3, 9>(residual, Eigen::Matrix<double, 9, 1>::Zero());
  EXPECT_LT((e.by_plane - J.leftCols<3>()).norm(), 1e-6 * J.norm());
  EXPECT_LT((e.by_pose - J.rightCols<6>()).norm(), 1e-6 * J.norm());
}

TEST(ViewEquations, TellThreeNumbersOfThePlaneAndOfThePose) {
  const ViewEquations e = EquationsOf(SomeView(), kPose, kPlane, kAt);
  EXPECT_EQ(test::Rank(e.by_plane), 3);
  EXPECT_EQ(test::Rank(e.by_pose), 3);
  Eigen::Matrix<double, 3, 9> both;
  both << e.by_plane, e.by_pose;
  EXPECT_EQ(test::Rank(both), 3) << "a single view fixes nothing of both";
}

}  // namespace
}  // namespace plumb::runtime
