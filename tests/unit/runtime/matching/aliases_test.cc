#include "runtime/matching/aliases.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

namespace plumb::runtime {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

const Vector3d kOrigin(4e5, 5e6, 300);
const PlanarPose kPose{0.7, {3, -2}, 1.5};

AGraph PlanWith(double yaw_rad, const Vector3d& translation) {
  AGraph plan;
  plan.origin = kOrigin;
  plan.aliases.emplace_back();
  plan.aliases[0].yaw_rad = yaw_rad;
  plan.aliases[0].translation = translation;
  return plan;
}

// In the plan frame.
Vector3d Placed(const PlanarPose& pose, const Vector3d& p) {
  return kOrigin + AngleAxisd(pose.yaw_rad, Vector3d::UnitZ()) * p + Vector3d(pose.t_m.x(), pose.t_m.y(), pose.z_m);
}

TEST(AliasedPoses, MovePointsOfThePlanFrameForthAndBack) {
  const Vector3d center = kOrigin + Vector3d(12, 5, 0), step(0.5, 7.5, 2.8);
  const AngleAxisd turn(std::numbers::pi / 2, Vector3d::UnitZ());
  const Vector3d translation = center - turn * center + step;
  const std::vector<PlanarPose> poses = AliasedPoses(PlanWith(std::numbers::pi / 2, translation), kPose);
  ASSERT_EQ(poses.size(), 2u);
  for (const Vector3d& p : {Vector3d(0, 0, 0), Vector3d(1, 2, 3), Vector3d(-4, 1, 0.5)}) {
    const Vector3d here = Placed(kPose, p);
    EXPECT_LT((Placed(poses[0], p) - (turn * here + translation)).norm(), 1e-6);
    EXPECT_LT((turn * Placed(poses[1], p) + translation - here).norm(), 1e-6);
  }
}

TEST(AliasedPoses, AHalfTurnIsItsOwnInverse) {
  const Vector3d twice_center = 2 * (kOrigin + Vector3d(12, 5, 0));
  const std::vector<PlanarPose> poses = AliasedPoses(PlanWith(std::numbers::pi, {twice_center.x(), twice_center.y(), 0}), kPose);
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_LT((poses[0].t_m - Eigen::Vector2d(24 - 3, 10 + 2)).norm(), 1e-6);
  EXPECT_NEAR(std::abs(poses[0].yaw_rad - kPose.yaw_rad), std::numbers::pi, 1e-12);
}

TEST(AliasedPoses, AHalfTurnToAnotherStoreyHasAnInverse) {
  EXPECT_EQ(AliasedPoses(PlanWith(std::numbers::pi, {0, 0, 3}), kPose).size(), 2u);
}

TEST(AliasedPoses, NoneWithoutAliases) { EXPECT_TRUE(AliasedPoses(AGraph(), kPose).empty()); }

}  // namespace
}  // namespace plumb::runtime
