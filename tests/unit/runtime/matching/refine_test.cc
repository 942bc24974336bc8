#include "runtime/matching/refine.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/unit/runtime/matching/scenes.h"

namespace plumb::runtime {
namespace {

using test::OnTour;
using test::UprightPose;

// The pose, in the map view's frame, of a map whose frame is the plan's.
PlanarPose TruePose(const MapView& view) {
  PlanarPose pose;
  pose.t_m = view.center_m;
  return pose;
}

TEST(RefineOnWalls, ComesBackFromWithin40CmAnd4Degrees) {
  const AGraph house = test::MakeHouse();
  const PlanIndex plan(house);
  const MapView view = ViewMap(MakeSyntheticMap(house, OnTour(test::kWholeHouse, UprightPose(0, 0, 0, 0))), MatcherOptions());
  const PlanarPose truth = TruePose(view);
  test::Random random(1);
  for (int i = 0; i < 20; ++i) {
    PlanarPose start = truth;
    start.yaw_rad += random.Uniform(-0.07, 0.07);
    start.t_m += Eigen::Vector2d(random.Uniform(-0.25, 0.25), random.Uniform(-0.25, 0.25));
    const WallFit fit = RefineOnWalls(plan, view, start);
    EXPECT_LT((fit.pose.t_m - truth.t_m).norm(), 0.01);
    EXPECT_LT(std::abs(fit.pose.yaw_rad), 0.003);
    EXPECT_GT(fit.consistent_ratio, 0.9);
    EXPECT_EQ(fit.consistent_planes, 8);
  }
}

TEST(RefineOnWalls, LeavesADeviatedWallOut) {
  const AGraph house = test::MakeHouse();
  const PlanIndex plan(house);
  AGraph built = house;
  test::DeviateWall(built, WallId(1), 0.35, 0.1);
  const MapView view = ViewMap(MakeSyntheticMap(built, OnTour(test::kWholeHouse, UprightPose(0, 0, 0, 0))), MatcherOptions());
  const WallFit fit = RefineOnWalls(plan, view, TruePose(view));
  EXPECT_LT((fit.pose.t_m - view.center_m).norm(), 0.01);
  EXPECT_EQ(fit.consistent_planes, 7);
}

TEST(AssessOnWalls, MeasuresTheScale) {
  const AGraph house = test::MakeHouse();
  const PlanIndex plan(house);
  const AGraph larger = test::Scaled(house, 1.005);
  const MapView view = ViewMap(MakeSyntheticMap(larger, OnTour(test::kWholeHouse, UprightPose(0, 0, 0, 0))), MatcherOptions());
  const WallFit fit = RefineOnWalls(plan, view, TruePose(view));
  EXPECT_NEAR(fit.scale_error, 0.005, 0.001);
  EXPECT_LT(fit.sigma_scale, 0.01);
}

TEST(AssessOnWalls, IsTheLessSureTheRougherTheMap) {
  const AGraph house = test::MakeHouse();
  const PlanIndex plan(house);
  MapView view = ViewMap(MakeSyntheticMap(house, OnTour(test::kWholeHouse, UprightPose(0, 0, 0, 0))), MatcherOptions());
  view.wall_sigma_m = 0.02;
  const WallFit fine = AssessOnWalls(plan, view, TruePose(view));
  view.wall_sigma_m = 0.035;
  const WallFit rough = AssessOnWalls(plan, view, TruePose(view));
  EXPECT_NEAR(rough.sigma_scale, 1.75 * fine.sigma_scale, 0.01 * fine.sigma_scale);
  EXPECT_LT((1.75 * 1.75 * rough.information - fine.information).norm(), 1e-6 * fine.information.norm());
}

// What the noise alone explains holds the pose, but is no plane that tells this place from others.
TEST(AssessOnWalls, CountsNoMorePlanesInARoughMap) {
  const AGraph house = test::MakeHouse();
  const PlanIndex plan(house);
  AGraph built = house;
  test::DeviateWall(built, WallId(1), 0.08, 0);
  MapView view = ViewMap(MakeSyntheticMap(built, OnTour(test::kWholeHouse, UprightPose(0, 0, 0, 0))), MatcherOptions());
  for (const double sigma_m : {0.02, 0.035}) {
    view.wall_sigma_m = sigma_m;
    EXPECT_EQ(AssessOnWalls(plan, view, TruePose(view)).consistent_planes, 7);
  }
}

// At rough ranges the side of a cupboard before a wall passes for a piece of it. The wall behind stands as planned all the same.
TEST(AssessOnWalls, CountsAWallThatSomethingStandsBefore) {
  const AGraph house = test::MakeHouse();
  const PlanIndex plan(house);
  MapView view = ViewMap(MakeSyntheticMap(house, OnTour(test::kWholeHouse, UprightPose(0, 0, 0, 0))), MatcherOptions());
  view.wall_sigma_m = 0.035;
  const WallFit bare = AssessOnWalls(plan, view, TruePose(view));
  MapWall cupboard = view.walls.front();
  for (Eigen::Vector2d* end : {&cupboard.start, &cupboard.end}) *end += 0.12 * cupboard.normal;
  view.walls.push_back(cupboard);
  const WallFit furnished = AssessOnWalls(plan, view, TruePose(view));
  EXPECT_EQ(furnished.consistent_planes, bare.consistent_planes);
  EXPECT_NEAR(furnished.consistent_ratio, bare.consistent_ratio, 1e-9);
  EXPECT_LT((furnished.information - bare.information).norm(), 1e-6 * bare.information.norm());
}

TEST(AssessOnWalls, HasNoInformationWhereNoMajorityOfWallsAgrees) {
  // Two walls across x, one of them moved: either may be the one as planned.
  const AGraph box = test::MakeGridPlan({0, 5}, {0, 4}, {});
  const PlanIndex plan(box);
  AGraph built = box;
  test::DeviateWall(built, WallId(1), 0.3, 0);
  const MapView view = ViewMap(MakeSyntheticMap(built, OnTour({{2, 2}, {3, 2.5}}, UprightPose(0, 0, 0, 0))), MatcherOptions());
  const WallFit fit = RefineOnWalls(plan, view, TruePose(view));
  EXPECT_LT(fit.information(0, 0), 1.0);
  EXPECT_GT(fit.information(1, 1), 1000.0);
}

}  // namespace
}  // namespace plumb::runtime
