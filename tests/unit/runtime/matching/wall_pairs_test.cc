#include "runtime/matching/wall_pairs.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/unit/runtime/matching/scenes.h"

namespace plumb::runtime {
namespace {

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

}  // namespace
}  // namespace plumb::runtime
