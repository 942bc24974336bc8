#include "runtime/matching/map_view.h"

#include <gtest/gtest.h>

#include "tests/unit/runtime/matching/scenes.h"

namespace plumb::runtime {
namespace {

MapView ViewOfHouse() {
  return ViewMap(MakeSyntheticMap(test::MakeHouse(), test::OnTour(test::kFromA, test::UprightPose(25, 1, 2, 0.3))), MatcherOptions());
}

TEST(ViewMap, WallsAreUprightLongEnoughAndAboutTheMiddle) {
  const MapView view = ViewOfHouse();
  ASSERT_GE(view.walls.size(), 4u);
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  double length_m = 0;
  for (const MapWall& wall : view.walls) {
    EXPECT_GE(wall.length_m, 0.4);
    EXPECT_NEAR((wall.end - wall.start).norm(), wall.length_m, 1e-9);
    EXPECT_NEAR(wall.normal.dot(wall.along), 0, 1e-9);
    moment += 0.5 * wall.length_m * (wall.start + wall.end);
    length_m += wall.length_m;
  }
  EXPECT_LT(moment.norm() / length_m, 1e-9);
  EXPECT_NEAR(view.wall_length_m, length_m, 1e-9);
}

TEST(ScaledView, MovesWallsAndWhereRaysEndInThePlaneOnly) {
  const MapView view = ViewOfHouse();
  constexpr double kScale = 1.025;
  const MapView scaled = Scaled(view, kScale);
  ASSERT_EQ(scaled.walls.size(), view.walls.size());
  for (size_t i = 0; i < view.walls.size(); ++i) {
    EXPECT_LT((scaled.walls[i].start - kScale * view.walls[i].start).norm(), 1e-12);
    EXPECT_LT((scaled.walls[i].end - kScale * view.walls[i].end).norm(), 1e-12);
    EXPECT_NEAR((scaled.walls[i].end - scaled.walls[i].start).norm(), scaled.walls[i].length_m, 1e-9);
  }
  EXPECT_NEAR(scaled.wall_length_m, kScale * view.wall_length_m, 1e-9);
  ASSERT_EQ(scaled.rays.size(), view.rays.size());
  ASSERT_FALSE(view.rays.empty());
  for (size_t i = 0; i < view.rays.size(); ++i) {
    const Eigen::Vector3d end = view.rays[i].origin + view.rays[i].range_m * view.rays[i].direction;
    const Eigen::Vector3d moved = scaled.rays[i].origin + scaled.rays[i].range_m * scaled.rays[i].direction;
    EXPECT_LT((moved - Eigen::Vector3d(kScale * end.x(), kScale * end.y(), end.z())).norm(), 1e-9);
    EXPECT_NEAR(scaled.rays[i].direction.norm(), 1, 1e-9);
    EXPECT_EQ(scaled.rays[i].wall, view.rays[i].wall);
  }
}

}  // namespace
}  // namespace plumb::runtime
