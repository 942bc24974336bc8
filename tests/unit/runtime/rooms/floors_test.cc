#include "runtime/rooms/floors.h"

#include <gtest/gtest.h>

#include <vector>

namespace plumb::runtime {
namespace {

void AddKeyframe(SGraph& graph, double x, double z_m) {
  const auto id = static_cast<uint32_t>(graph.keyframes.size());
  Keyframe& keyframe = graph.keyframes.emplace_back();
  keyframe.id = id;
  keyframe.T_map_kf.translation() = Eigen::Vector3d(x, 0, z_m);
}

// Level, seen from keyframes first to last.
void AddLevel(SGraph& graph, SurfaceKind kind, double z_m, double area_m2, uint32_t first, uint32_t last) {
  MapSurface surface;
  surface.id = static_cast<uint32_t>(graph.surfaces.size());
  surface.kind = kind;
  surface.z_min_m = surface.z_max_m = z_m;
  surface.area_m2 = area_m2;
  for (uint32_t k = first; k <= last; ++k) surface.observations.push_back({k, {}});
  graph.surfaces.push_back(surface);
}

// 5 m on one floor, stairs with a landing, 3 m on the next, 2.8 m above; the sensor 0.6 m above the floor.
SGraph UpTheStairs() {
  SGraph graph;
  for (int i = 0; i <= 10; ++i) AddKeyframe(graph, 0.5 * i, 0.6);                  // 0 to 10
  for (int i = 1; i <= 4; ++i) AddKeyframe(graph, 5 + 0.4 * i, 0.6 + 0.35 * i);    // 11 to 14
  for (int i = 0; i <= 2; ++i) AddKeyframe(graph, 6.6, 2.0);                       // 15 to 17: on the landing
  for (int i = 1; i <= 3; ++i) AddKeyframe(graph, 6.6 - 0.4 * i, 2.0 + 0.35 * i);  // 18 to 20
  for (int i = 0; i <= 6; ++i) AddKeyframe(graph, 5 - 0.5 * i, 3.4);               // 21 to 27
  return graph;
}

TEST(FindFloors, FindsTwoFloorsJoinedByStairs) {
  SGraph graph = UpTheStairs();
  AddLevel(graph, SurfaceKind::kFloor, 0.0, 20, 0, 10);
  AddLevel(graph, SurfaceKind::kFloor, 0.45, 2, 0, 10);  // a table
  AddLevel(graph, SurfaceKind::kFloor, 1.4, 3, 12, 17);  // the landing
  AddLevel(graph, SurfaceKind::kFloor, 2.8, 15, 21, 27);
  AddLevel(graph, SurfaceKind::kCeiling, 2.6, 12, 0, 10);
  AddLevel(graph, SurfaceKind::kCeiling, 0.7, 14, 0, 10);  // undersides of tables
  const std::vector<MapFloor> floors = FindFloors(graph, {});
  ASSERT_EQ(floors.size(), 2u);
  EXPECT_EQ(floors[0].id, 0u);
  EXPECT_EQ(floors[1].id, 1u);
  ASSERT_TRUE(floors[0].floor_z_m && floors[1].floor_z_m && floors[0].ceiling_z_m);
  EXPECT_NEAR(*floors[0].floor_z_m, 0, 1e-9);
  EXPECT_NEAR(*floors[1].floor_z_m, 2.8, 1e-9);
  EXPECT_NEAR(*floors[0].ceiling_z_m, 2.6, 1e-9);
  EXPECT_FALSE(floors[1].ceiling_z_m);
  EXPECT_EQ(floors[0].keyframes.size() + floors[1].keyframes.size(), graph.keyframes.size());
  EXPECT_EQ(floors[1].keyframes.back(), 27u);
  EXPECT_EQ(floors[0].keyframes.front(), 0u);
}

TEST(FindFloors, IsOneWhereTheHigherPlaceHasNoFloor) {
  SGraph graph = UpTheStairs();
  AddLevel(graph, SurfaceKind::kFloor, 0.0, 20, 0, 10);
  EXPECT_EQ(FindFloors(graph, {}).size(), 1u);
}

TEST(FindFloors, IsOneWhereTheRobotOnlyStoodHigher) {
  SGraph graph;
  for (int i = 0; i <= 10; ++i) AddKeyframe(graph, 0.5 * i, 0.6);
  for (int i = 0; i <= 3; ++i) AddKeyframe(graph, 5 + 0.2 * i, 2.4);  // on a table top, say
  EXPECT_EQ(FindFloors(graph, {}).size(), 1u);
}

TEST(FindFloors, OfNoKeyframesAreNone) { EXPECT_TRUE(FindFloors({}, {}).empty()); }

}  // namespace
}  // namespace plumb::runtime
