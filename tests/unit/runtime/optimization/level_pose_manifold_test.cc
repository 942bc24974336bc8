#include "runtime/optimization/level_pose_manifold.h"

#include <gtest/gtest.h>

#include <array>

namespace plumb::runtime {
namespace {

using Pose = Eigen::Matrix<double, kPoseSize, 1>;

// A laser that leans: the manifold keeps that.
Pose LeaningPose() {
  Pose x;
  x.head<4>() = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, 0).normalized())).coeffs();
  x.tail<3>() << 1, -2, 0.4;
  return x;
}

Pose Plus(const Pose& x, const Eigen::Vector3d& delta) {
  Pose out;
  EXPECT_TRUE(LevelPoseManifold().Plus(x.data(), delta.data(), out.data()));
  return out;
}

TEST(LevelPoseManifold, MovesInThePlaneAndTurnsAboutTheVertical) {
  const Pose x = LeaningPose(), y = Plus(x, {0.3, 0.5, -0.2});
  EXPECT_NEAR((y.tail<3>() - x.tail<3>() - Eigen::Vector3d(0.5, -0.2, 0)).norm(), 0, 1e-12);
  const Eigen::Quaterniond q_x(x.head<4>()), q_y(y.head<4>());
  EXPECT_TRUE((q_y * q_x.conjugate()).isApprox(Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ())), 1e-12));
}

TEST(LevelPoseManifold, MinusUndoesPlus) {
  const Pose x = LeaningPose();
  for (const Eigen::Vector3d& delta : {Eigen::Vector3d(0.3, 0.5, -0.2), Eigen::Vector3d(-2.5, 1, 1), Eigen::Vector3d(0, 0, 0)}) {
    const Pose y = Plus(x, delta);
    Eigen::Vector3d found;
    EXPECT_TRUE(LevelPoseManifold().Minus(y.data(), x.data(), found.data()));
    EXPECT_NEAR((found - delta).norm(), 0, 1e-12);
  }
}

TEST(LevelPoseManifold, PlusJacobianIsThatOfDifferences) {
  const Pose x = LeaningPose();
  Eigen::Matrix<double, kPoseSize, 3, Eigen::RowMajor> J;
  ASSERT_TRUE(LevelPoseManifold().PlusJacobian(x.data(), J.data()));
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 3; ++i) {
    const Pose column = (Plus(x, kStep * Eigen::Vector3d::Unit(i)) - Plus(x, -kStep * Eigen::Vector3d::Unit(i))) / (2 * kStep);
    EXPECT_NEAR((column - J.col(i)).norm(), 0, 1e-8) << i;
  }
}

// As Ceres wants it: of Minus(y, x) by y at y = x, for y on the manifold.
TEST(LevelPoseManifold, MinusJacobianInvertsThatOfPlus) {
  const Pose x = LeaningPose();
  Eigen::Matrix<double, kPoseSize, 3, Eigen::RowMajor> plus;
  Eigen::Matrix<double, 3, kPoseSize, Eigen::RowMajor> minus;
  ASSERT_TRUE(LevelPoseManifold().PlusJacobian(x.data(), plus.data()));
  ASSERT_TRUE(LevelPoseManifold().MinusJacobian(x.data(), minus.data()));
  EXPECT_TRUE((minus * plus).isApprox(Eigen::Matrix3d::Identity(), 1e-12));
}

}  // namespace
}  // namespace plumb::runtime
