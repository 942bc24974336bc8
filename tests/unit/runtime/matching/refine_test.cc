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

TEST(FaceDistance, JacobianIsTheDerivative) {
  test::Random random(3);
  for (int i = 0; i < 50; ++i) {
    PlanFace face;
    const double a = random.Uniform(-3, 3);
    face.normal = {std::cos(a), std::sin(a)};
    face.d_m = random.Uniform(-5, 5);
    PlanarPose pose;
    pose.yaw_rad = random.Uniform(-3, 3);
    pose.t_m = {random.Uniform(-5, 5), random.Uniform(-5, 5)};
    const Eigen::Vector2d p(random.Uniform(-5, 5), random.Uniform(-5, 5));
    Eigen::Vector4d jacobian;
    (void)FaceDistance(face, pose, p, &jacobian);
    const auto at = [&](int k, double h) {
      PlanarPose moved = pose;
      if (k < 2) moved.t_m[k] += h;
      if (k == 2) moved.yaw_rad += h;
      return FaceDistance(face, moved, k == 3 ? ((1 + h) * p).eval() : p, nullptr);
    };
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(jacobian[k], (at(k, 1e-6) - at(k, -1e-6)) / 2e-6, 1e-7) << "parameter " << k;
  }
}

TEST(PairWalls, GivesOneMapWallTheFacesOfAllRoomsItRunsPast) {
  const AGraph house = test::MakeHouse();
  const PlanIndex plan(house);
  MapView view;
  MapWall south;  // along y = 0 through the rooms A and C
  south.start = {0.2, 0.01};
  south.end = {8.0, 0.01};
  south.along = {1, 0};
  south.normal = {0, 1};
  south.length_m = 7.8;
  south.z_max_m = 2;
  view.walls.push_back(south);
  const std::vector<WallPair> pairs = PairWalls(plan, view, PlanarPose());
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_NEAR(pairs[0].overlap_m + pairs[1].overlap_m, 7.8 - 0.12, 1e-9);
  for (const WallPair& p : pairs) {
    EXPECT_EQ(house.surfaces[plan.faces()[p.face].surface.index()].wall, WallId(0));
    EXPECT_NEAR(FaceDistance(plan.faces()[p.face], PlanarPose(), p.p, nullptr), 0.01, 1e-9);
  }
}

TEST(PairWalls, NeverTakesTheOtherSideOfAWall) {
  const AGraph house = test::MakeHouse();
  const PlanIndex plan(house);
  MapView view;
  MapWall across;  // the side of the wall y = 3.5 that faces A, normal down
  across.start = {4.5, 3.44};
  across.end = {3.2, 3.44};
  across.along = {-1, 0};
  across.normal = {0, -1};
  across.length_m = 1.3;
  across.z_max_m = 2;
  view.walls.push_back(across);
  for (double shift_m : {-0.3, -0.1, 0.0, 0.1, 0.3}) {
    PlanarPose pose;
    pose.t_m.y() = shift_m;
    const std::vector<WallPair> pairs = PairWalls(plan, view, pose);
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_LT(plan.faces()[pairs[0].face].normal.y(), -0.9);
  }
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
