#include "compiler/passes/wall_surfaces.h"

#include <gtest/gtest.h>

#include "compiler/passes/polygon.h"
#include "tests/support/plan_builder.h"
#include "tests/unit/compiler/passes/build.h"

namespace plumb::compiler {
namespace {

TEST(AddSurfaces, FaceTheRoomWithItOnTheLeft) {
  const AGraph graph = Build(test::TwoRooms()).graph;
  const Room* west = FindRoom(graph, "West");
  ASSERT_TRUE(west != nullptr);
  ASSERT_EQ(west->surfaces.size(), 4u);
  for (SurfaceId id : west->surfaces) {
    const Surface& s = graph.surfaces[id.index()];
    EXPECT_NEAR(s.normal.norm(), 1, 1e-12);
    EXPECT_NEAR(s.normal.head<2>().dot(Rot90Ccw((s.end - s.start).normalized())), 1, 1e-12);
    EXPECT_NEAR(s.normal.head<2>().dot(s.start) + s.d_m, 0, 1e-9);
    EXPECT_GT(s.normal.head<2>().dot(west->center.head<2>()) + s.d_m, 1.0);
    EXPECT_DOUBLE_EQ(s.z_min_m, 0);
    EXPECT_DOUBLE_EQ(s.z_max_m, 2.5);
  }
  // Hand computed: the inner wall's west face.
  const auto inner = std::find_if(graph.surfaces.begin(), graph.surfaces.end(), [&](const Surface& s) {
    return graph.walls[s.wall.index()].guid == "inner" && s.room.valid() && &graph.rooms[s.room.index()] == west;
  });
  ASSERT_NE(inner, graph.surfaces.end());
  EXPECT_TRUE(inner->normal.isApprox(Eigen::Vector3d(-1, 0, 0), 1e-9));
  EXPECT_NEAR(inner->d_m, 4.9, 1e-9);
  EXPECT_TRUE(inner->start.isApprox(Eigen::Vector2d(4.9, 0), 1e-9) || inner->start.norm() < 1e-9);
  EXPECT_TRUE(inner->end.isApprox(Eigen::Vector2d(4.9, 4), 1e-9));
}

TEST(AddSurfaces, ExteriorSurfacesFaceAway) {
  const AGraph graph = Build(test::TwoRooms()).graph;
  double length = 0;
  for (const Surface& s : graph.surfaces) {
    if (s.room.valid()) continue;
    length += s.length_m();
    EXPECT_GT(s.normal.head<2>().dot(s.midpoint() - Eigen::Vector2d(4, 2)), 0);
  }
  EXPECT_NEAR(length, 2 * (8.6 + 4.6), 1e-6);
  for (const char* guid : {"south", "east", "north", "west"}) EXPECT_TRUE(FindWall(graph, guid)->external) << guid;
  EXPECT_FALSE(FindWall(graph, "inner")->external);
}

TEST(AddSurfaces, AWallAlongTwoRoomsHasOneSurfaceForEach) {
  const AGraph graph = Build(test::TwoRooms()).graph;
  size_t south = 0;
  for (const Surface& s : graph.surfaces) south += s.room.valid() && graph.walls[s.wall.index()].guid == "south";
  EXPECT_EQ(south, 2u);
}

TEST(AddSurfaces, TheSideOwnsAnEdgeBeforeAnEnd) {
  // A partition whose end lies flush within the outline of a thick wall: the face belongs to the thick wall.
  PlanIr plan = test::TwoRooms();
  test::PlanBuilder b;
  b.plan = plan;
  b.On(0).Prismatic(ElementKind::kWall, "flush", test::Rectangle({2.0, -0.3}, {2.2, 0}), 0, 2.5);
  const AGraph graph = Build(b.plan).graph;
  const Room* west = FindRoom(graph, "West");
  ASSERT_TRUE(west != nullptr);
  EXPECT_EQ(west->surfaces.size(), 4u);
}

TEST(AddFactors, TieWallsRoomsDoorwaysAndStoreys) {
  const AGraph graph = Build(test::TwoRooms()).graph;
  size_t count[4] = {0, 0, 0, 0};
  for (const Factor& f : graph.factors) {
    ++count[static_cast<size_t>(f.kind)];
    if (f.kind == FactorKind::kWallSurfaces) {
      const Surface &a = graph.surfaces[f.variables[1]], &b = graph.surfaces[f.variables[2]];
      EXPECT_EQ(a.wall.value, f.variables[0]);
      EXPECT_EQ(b.wall.value, f.variables[0]);
      EXPECT_NEAR(-(a.d_m + b.d_m), graph.walls[f.variables[0]].thickness_m, 1e-9);
    }
    if (f.kind == FactorKind::kRoomSurfaces) {
      EXPECT_EQ(f.variables.size(), 5u);
    }
  }
  // Inner wall 1; south and north face two rooms each, east and west one: 6 pairs with the outside.
  EXPECT_EQ(count[0], 7u);
  EXPECT_EQ(count[1], 2u);
  EXPECT_EQ(count[2], 1u);
  EXPECT_EQ(count[3], 2u);
}

}  // namespace
}  // namespace plumb::compiler
