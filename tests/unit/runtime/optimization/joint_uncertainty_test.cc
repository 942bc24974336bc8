// What the joint problem says of how well it knows: covariances, and directions that nothing holds.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/unit/runtime/optimization/solved_drive.h"

namespace plumb::runtime {
namespace {

using test::Drive;
using test::DriveOptions;

TEST(JointUncertainty, TwoSigmaCovers) {
  const AGraph house = test::MakeHouse();
  int inside = 0, total = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const DriveOptions options = WithDeviations(seed, {{kEast, {0.2, 3 * kDeg}}});
    const Solved s = Solve(house, options);
    for (const WallEstimate& w : s.result.walls) {
      const WallDeviation truth = options.deviations[w.wall.index()];
      inside += std::abs(w.deviation.offset_m - truth.offset_m) < 2 * std::sqrt(w.cov(0, 0));
      inside += std::abs(w.deviation.yaw_rad - truth.yaw_rad) < 2 * std::sqrt(w.cov(1, 1));
      total += 2;
      EXPECT_LT(std::sqrt(w.cov(0, 0)), 0.02);
      EXPECT_LT(std::sqrt(w.cov(1, 1)), 0.3 * kDeg);
    }
    const Eigen::Vector3d e = s.result.T_plan_map.translation() - s.drive.T_plan_map.translation();
    for (int i = 0; i < 2; ++i) inside += std::abs(e[i]) < 2 * std::sqrt(s.result.cov_xy_yaw(i, i)), ++total;
  }
  EXPECT_GT(inside, 0.94 * total);
}

// The prior's tolerance is part of the stated sigma: a house whose walls all stand off by it is covered, too.
TEST(JointUncertainty, TwoSigmaCoversWallsWithinTolerance) {
  const AGraph house = test::MakeHouse();
  test::Random random(4);
  int inside = 0, total = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    DriveOptions options = WithDeviations(seed, {});
    for (WallDeviation& d : options.deviations)
      d = {random.Normal(CouplingOptions{}.offset_tau0_m), random.Normal(CouplingOptions{}.yaw_tau0_rad)};
    const Solved s = Solve(house, options);
    for (const WallEstimate& w : s.result.walls) {
      inside += std::abs(w.deviation.offset_m - options.deviations[w.wall.index()].offset_m) < 2 * std::sqrt(w.cov(0, 0));
      inside += std::abs(w.deviation.yaw_rad - options.deviations[w.wall.index()].yaw_rad) < 2 * std::sqrt(w.cov(1, 1));
      total += 2;
    }
  }
  EXPECT_GT(inside, 0.90 * total);
}

TEST(JointUncertainty, TellsWhereTheFrameRestsOnOneWall) {
  const AGraph house = test::MakeHouse();
  const Solved s = Solve(house, WithDeviations(1, {{kEast, {0.2, 0}}}));
  ASSERT_EQ(s.result.directions.size(), 2u);
  EXPECT_NEAR(s.result.directions[0].axis_rad, 0, 1e-6);
  EXPECT_EQ(s.result.directions[0].consistent, 2);  // west and middle against east
  EXPECT_EQ(s.result.directions[0].next_cluster, 1);
  EXPECT_TRUE(s.result.directions[0].ambiguous());
  EXPECT_NEAR(s.result.directions[1].axis_rad, std::numbers::pi / 2, 1e-6);
  EXPECT_EQ(s.result.directions[1].margin(), 3);
  EXPECT_FALSE(s.result.directions[1].ambiguous());
  EXPECT_NE(s.result.gauge.find("ambiguous"), std::string::npos);
}

// Only the west and middle walls: nothing tells where the plan lies along y. The answer must say so.
TEST(JointUncertainty, CorridorLeavesItsDirectionOpen) {
  const AGraph house = test::MakeHouse();
  Drive drive = test::DriveThroughHouse(house, WithDeviations(1, {}));
  std::vector<Match> matches = MatchSurfaces(drive.map, house, drive.T_plan_map, {});
  std::erase_if(matches, [&](const Match& m) {
    return m.plan_surface.valid() && house.surfaces[m.plan_surface.index()].wall != WallId(kWest) &&
           house.surfaces[m.plan_surface.index()].wall != WallId(kMiddle);
  });
  const JointResult result = OptimizeJointly(drive.map, house, matches, drive.T_plan_map);
  EXPECT_TRUE(result.converged);
  EXPECT_GT(std::sqrt(result.cov_xy_yaw(1, 1)), 1.0);
  EXPECT_LT(std::sqrt(result.cov_xy_yaw(0, 0)), 0.05);
}

// A deviation without a prior absorbs its own factor: then the plan does not hold the map, however precise the map is.
TEST(JointUncertainty, OnlyThePriorOnDeviationsTiesThePlan) {
  const AGraph house = test::MakeHouse();
  const Drive drive = test::DriveThroughHouse(house, WithDeviations(1, {}));
  const std::vector<Match> matches = MatchSurfaces(drive.map, house, drive.T_plan_map, {});
  JointOptions options;
  options.coupling.offset_tau0_m = 10;
  options.coupling.offset_tau1_m = 11;
  options.coupling.yaw_tau0_rad = 3;
  options.coupling.yaw_tau1_rad = 4;
  for (const double precision : {1.0, 0.01}) {
    options.point_sigma_m = 0.03 * precision;
    options.observation_floor_m = 0.005 * precision;
    options.observation_floor_rad = 0.003 * precision;
    const JointResult result = OptimizeJointly(drive.map, house, matches, drive.T_plan_map, options);
    EXPECT_GT(std::sqrt(result.cov_xy_yaw(0, 0)), 2.0);
    EXPECT_GT(std::sqrt(result.cov_xy_yaw(1, 1)), 2.0);
  }
}

}  // namespace
}  // namespace plumb::runtime
