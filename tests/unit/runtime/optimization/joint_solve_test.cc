// The joint problem's solve itself: repeatable, quick from a good start, and honest about bad input.
#include <gtest/gtest.h>

#include "tests/unit/runtime/optimization/solved_drive.h"

namespace plumb::runtime {
namespace {

using test::Drive;

TEST(JointSolve, SameInputSameBytes) {
  const AGraph house = test::MakeHouse();
  const Drive drive = test::DriveThroughHouse(house, WithDeviations(8, {{kSouth, {0.1, 0.02}}}));
  const std::vector<Match> matches = MatchSurfaces(drive.map, house, drive.T_plan_map, {});
  const JointResult a = OptimizeJointly(drive.map, house, matches, drive.T_plan_map),
                    b = OptimizeJointly(drive.map, house, matches, drive.T_plan_map);
  EXPECT_EQ(a.T_plan_map.matrix(), b.T_plan_map.matrix());
  EXPECT_EQ(a.cov_xy_yaw, b.cov_xy_yaw);
  ASSERT_EQ(a.walls.size(), b.walls.size());
  for (size_t i = 0; i < a.walls.size(); ++i) {
    EXPECT_EQ(a.walls[i].deviation.offset_m, b.walls[i].deviation.offset_m);
    EXPECT_EQ(a.walls[i].cov_all, b.walls[i].cov_all);
  }
  EXPECT_EQ(a.gauge, b.gauge);
}

TEST(JointSolve, WarmStartTakesFewIterations) {
  const AGraph house = test::MakeHouse();
  Solved s = Solve(house, WithDeviations(8, {{kSouth, {0.1, 0.02}}}));
  const JointResult again = OptimizeJointly(s.drive.map, house, s.matches, s.result.T_plan_map);
  EXPECT_LE(again.iterations, 6);
  EXPECT_LT((again.T_plan_map.translation() - s.result.T_plan_map.translation()).norm(), 1e-3);
}

TEST(JointSolve, StartsAsAFailureAndNamesBadInput) {
  const AGraph house = test::MakeHouse();
  EXPECT_EQ(JointResult{}.message, "not run");
  EXPECT_FALSE(JointResult{}.converged);
  const JointResult empty = OptimizeJointly({}, house, {}, Eigen::Isometry3d::Identity());
  EXPECT_FALSE(empty.converged);
  EXPECT_EQ(empty.message, "the map has no keyframes");
  const Drive drive = test::DriveThroughHouse(house, {});
  EXPECT_FALSE(OptimizeJointly(drive.map, house, {{0, SurfaceId(999), RoomId(), 0, 0, {}}}, drive.T_plan_map).converged);
  JointOptions options;
  options.correlation = 0.5;
  EXPECT_EQ(options.Check(), "JointOptions.correlation = 0.5; must be >= 1");
  EXPECT_EQ(OptimizeJointly(drive.map, house, {}, drive.T_plan_map, options).message, options.Check());
}

TEST(JointSolve, WithoutMatchesItIsPlainSlam) {
  const AGraph house = test::MakeHouse();
  const Drive drive = test::DriveThroughHouse(house, {});
  const JointResult result = OptimizeJointly(drive.map, house, {}, drive.T_plan_map);
  EXPECT_TRUE(result.converged) << result.message;
  EXPECT_TRUE(result.walls.empty());
  double worst = 0;
  for (size_t k = 0; k < result.T_map_kf.size(); ++k) {
    worst = std::max(worst, (drive.T_plan_map * result.T_map_kf[k].translation() - drive.T_plan_kf[k].translation()).norm());
  }
  EXPECT_LT(worst, 0.04);
}

}  // namespace
}  // namespace plumb::runtime
