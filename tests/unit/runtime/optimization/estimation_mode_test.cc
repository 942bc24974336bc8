#include "runtime/optimization/estimation_mode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "runtime/optimization/joint_optimizer.h"
#include "tests/support/house.h"
#include "tests/support/synthetic_sgraph.h"

namespace plumb::runtime {
namespace {

TEST(EstimationMode, IsKnownByItsName) {
  EXPECT_EQ(ModeNames(), (std::vector<std::string>{"dis", "is", "uc", "so"}));
  for (const std::string& name : ModeNames()) EXPECT_EQ(ModeName(ParseMode(name).value()), name);
  EXPECT_FALSE(ParseMode("DIS").has_value());
  EXPECT_FALSE(ParseMode("").has_value());
}

struct Errors {
  double place_m = 0;  // of the keyframe furthest from where it was
  double largest_offset_m = 0, p_of_the_deviated = 0;
  std::string gauge;
};

// The house with its east wall 30 cm and its north wall 20 cm off, `passes` times coupled and solved from a fix that is 6 cm off, or a
// share of that.
Errors SolveIn(EstimationMode mode, int passes = 1, double share = 1) {
  const AGraph house = test::MakeHouse();
  test::DriveOptions drive_options;
  drive_options.deviations.assign(house.walls.size(), {});
  constexpr size_t kEast = 1, kNorth = 2;
  drive_options.deviations[kEast].offset_m = 0.30;
  drive_options.deviations[kNorth].offset_m = -0.20;
  test::Drive drive = test::DriveThroughHouse(house, drive_options);
  JointOptions options;
  options.mode = mode;
  JointResult result;
  Eigen::Isometry3d T = test::Disturbed(drive.T_plan_map, share * 0.05, share * -0.04, share * 0.01);
  std::vector<WallDeviation> known;
  for (int i = 0; i < passes; ++i) {
    result = OptimizeJointly(drive.map, house, MatchSurfaces(drive.map, house, T, known), T, options);
    T = result.T_plan_map;
    known = result.Deviations(house.walls.size());
    for (size_t k = 0; k < result.T_map_kf.size(); ++k) drive.map.keyframes[k].T_map_kf = result.T_map_kf[k];
  }
  EXPECT_EQ(result.T_map_kf.size(), drive.T_plan_kf.size()) << result.message;
  EXPECT_TRUE(result.covariances_exact);
  Errors errors{0, 0, 1, result.gauge};
  for (size_t k = 0; k < result.T_map_kf.size(); ++k) {
    errors.place_m = std::max(errors.place_m, (T * result.T_map_kf[k].translation() - drive.T_plan_kf[k].translation()).norm());
  }
  for (const WallEstimate& w : result.walls) {
    errors.largest_offset_m = std::max(errors.largest_offset_m, std::abs(w.deviation.offset_m));
    if (w.wall.index() == kEast || w.wall.index() == kNorth) errors.p_of_the_deviated = std::min(errors.p_of_the_deviated, w.p_deviated);
  }
  return errors;
}

TEST(EstimationMode, WholeMethodFindsPlaceAndDeviations) {
  const Errors dis = SolveIn(EstimationMode::kDis);
  EXPECT_LT(dis.place_m, 0.02);
  EXPECT_NEAR(dis.largest_offset_m, 0.30, 0.02);
  EXPECT_GT(dis.p_of_the_deviated, 0.99);
}

TEST(EstimationMode, WithoutDeviationsAllWallsStandAsPlannedAndDragThePlace) {
  const Errors is = SolveIn(EstimationMode::kIs);
  EXPECT_EQ(is.largest_offset_m, 0);
  EXPECT_EQ(is.p_of_the_deviated, 0);
  EXPECT_GT(is.place_m, 0.03);
  EXPECT_NE(is.gauge.find("mode is"), std::string::npos) << is.gauge;
}

// Half of what the deviated walls are off by goes into the place, as all walls of a direction count alike.
TEST(EstimationMode, UniformCovariancesShareADeviationAmongPlaceAndWalls) {
  const Errors uc = SolveIn(EstimationMode::kUc, 3);
  EXPECT_GT(uc.place_m, 0.03);
  EXPECT_LT(uc.largest_offset_m, 0.28);
}

// From a start that is nearer to what the deviated walls say it does not come back, however often it is solved again.
TEST(EstimationMode, ASingleOptimizationKeepsAWrongStart) {
  const double so_m = SolveIn(EstimationMode::kSo, 4).place_m, dis_m = SolveIn(EstimationMode::kDis, 4).place_m;
  EXPECT_LT(dis_m, 0.02);
  EXPECT_GT(so_m, dis_m + 0.03);
}

// From 1 cm off it comes to the same place as the whole method, from 2 cm no more.
TEST(EstimationMode, ASingleOptimizationIsAsGoodAsItsStart) {
  EXPECT_LT(SolveIn(EstimationMode::kSo, 4, 0.16).place_m, 0.01);
  EXPECT_GT(SolveIn(EstimationMode::kSo, 4, 0.32).place_m, 0.05);
  for (const double share : {0.0, 0.32, 2.0, -3.0}) EXPECT_LT(SolveIn(EstimationMode::kDis, 4, share).place_m, 0.01) << share;
}

}  // namespace
}  // namespace plumb::runtime
