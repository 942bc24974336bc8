#include "runtime/matching/map_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

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

// Of the house, with something level `above_m` its floor that has `times` its points.
SGraph MapWithTable(double above_m, double times) {
  SGraph map = MakeSyntheticMap(test::MakeHouse(), test::OnTour(test::kFromA, test::UprightPose(25, 1, 2, 0.3)));
  const auto floor =
      std::find_if(map.surfaces.begin(), map.surfaces.end(), [](const MapSurface& s) { return s.kind == SurfaceKind::kFloor; });
  MapSurface table = *floor;
  table.plane.d -= table.plane.n.z() * above_m;
  table.num_points *= times;
  map.surfaces.push_back(table);
  return map;
}

TEST(ViewMap, WhatIsLevelBelowTheFloorWithMostPointsMayBeTheFloor) {
  const std::optional<double> floor_z_m = ViewOfHouse().floor_z_m;
  ASSERT_TRUE(floor_z_m);
  EXPECT_TRUE(ViewOfHouse().lower_floors_z_m.empty());
  const MapView view = ViewMap(MapWithTable(0.4, 3), MatcherOptions());
  EXPECT_NEAR(*view.floor_z_m, *floor_z_m + 0.4, 1e-6);
  ASSERT_EQ(view.lower_floors_z_m.size(), 1u);
  EXPECT_NEAR(view.lower_floors_z_m.front(), *floor_z_m, 1e-6);
  const MapView low = ViewMap(MapWithTable(0.4, 0.5), MatcherOptions());
  EXPECT_NEAR(*low.floor_z_m, *floor_z_m, 1e-6);
  EXPECT_TRUE(low.lower_floors_z_m.empty()) << "a table is no floor below the floor";
}

TEST(ViewMap, NoFloorIsAboveTheSensorAndNoCeilingBelow) {
  SGraph map = MapWithTable(3, 5);
  const std::optional<double> floor_z_m = ViewMap(map, MatcherOptions()).floor_z_m;
  EXPECT_NEAR(*floor_z_m, *ViewOfHouse().floor_z_m, 1e-6);
  map.surfaces.back() = MapWithTable(0.4, 5).surfaces.back();
  map.surfaces.back().kind = SurfaceKind::kCeiling;
  const std::optional<double> ceiling_z_m = ViewMap(map, MatcherOptions()).ceiling_z_m;
  EXPECT_EQ(ceiling_z_m.has_value(), ViewOfHouse().ceiling_z_m.has_value());
  EXPECT_GT(ceiling_z_m.value_or(9), *floor_z_m + 1);
}

TEST(Matcher, ATableWithMorePointsThanTheFloorIsNotTakenForIt) {
  const AGraph plan = test::MakeHouse();
  const MatchResult match = Matcher(plan).Match(MapWithTable(0.4, 3));
  ASSERT_FALSE(match.hypotheses.empty()) << match.reason;
  const Eigen::Isometry3d truth = test::UprightPose(25, 1, 2, 0.3);
  const test::PoseError error = test::ErrorOf(match.hypotheses.front().T_plan_map, truth, test::kFromA.front());
  EXPECT_LT(error.z_m, 0.1);
  EXPECT_LT(error.xy_m, 0.1);
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
