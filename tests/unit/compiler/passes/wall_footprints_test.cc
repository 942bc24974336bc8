#include "compiler/passes/wall_footprints.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "compiler/passes/polygon.h"
#include "tests/support/plan_builder.h"
#include "tests/unit/compiler/passes/build.h"

namespace plumb::compiler {
namespace {

FloorIr Cut(PlanIr plan, DiagnosticSink& sink) {
  AssignStoreys(plan, {}, sink);
  return CutFootprints(plan, GroupStoreys(plan, 1.1, {}), {}, sink);
}

TEST(CutFootprints, AWallOfTwoStoreysIsOnBothMapsAndIsOneWall) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  b.Storey("1", 3);
  b.On(0).Wall("tall", {0, 0}, {4, 0}, 0.3, 0, 6);
  b.On(1).Wall("upper", {0, 2}, {4, 2}, 0.3, 3, 6);
  DiagnosticSink sink;
  const FloorIr floors = Cut(b.plan, sink);
  ASSERT_EQ(floors.walls.size(), 2u);
  ASSERT_EQ(floors.floors.size(), 2u);
  EXPECT_EQ(floors.floors[0].footprints.size(), 1u);
  EXPECT_EQ(floors.floors[1].footprints.size(), 2u);
  EXPECT_EQ(floors.walls[0].storey, 0u);
  EXPECT_NEAR(RegionArea(floors.floors[1].footprints[0].rings), 1.2, 1e-9);
}

TEST(CutFootprints, PartsOfOneGuidAreOneWall) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  b.Wall("glazed", {0, 0}, {2, 0}, 0.1);
  b.Wall("glazed", {2, 0}, {4, 0}, 0.1);
  DiagnosticSink sink;
  const FloorIr floors = Cut(b.plan, sink);
  ASSERT_EQ(floors.walls.size(), 1u);
  EXPECT_EQ(floors.walls[0].elements.size(), 2u);
  EXPECT_EQ(floors.floors[0].footprints[0].rings.size(), 2u);
}

// Two walls in one line 1 m apart, a door 0.9 m wide between their ends, and another one in a wall.
TEST(CutFootprints, ADoorBetweenTheEndsOfWallsClosesTheGap) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  const uint32_t south = b.Wall("south", {-0.2, -0.1}, {2, -0.1}, 0.2);
  b.Wall("south too", {3, -0.1}, {6.2, -0.1}, 0.2);
  b.Wall("north", {-0.2, 4.1}, {6.2, 4.1}, 0.2);
  b.Wall("west", {-0.1, 0}, {-0.1, 4}, 0.2);
  b.Wall("east", {6.1, 0}, {6.1, 4}, 0.2);
  b.Prismatic(ElementKind::kDoor, "D", test::Rectangle({2.05, -0.12}, {2.95, -0.08}), 0, 2.1);
  b.Prismatic(ElementKind::kDoor, "open", test::Rectangle({4, 1}, {4.9, 1.9}), 0, 2.1);  // too deep for a leaf
  b.Door("inside", south, 1);
  DiagnosticSink sink;
  const Built built = Build(b.plan, sink);
  size_t fillings = 0;
  for (const Footprint& f : built.floors.floors[0].footprints) fillings += f.kind == FootprintKind::kFilling;
  EXPECT_EQ(fillings, 1u);
  ASSERT_EQ(built.graph.rooms.size(), 1u);
  EXPECT_NEAR(built.graph.rooms[0].area_m2, 24, 0.2);
  const auto& doorways = built.graph.doorways;
  const auto door = std::find_if(doorways.begin(), doorways.end(), [](const Doorway& d) { return d.guid == "D"; });
  ASSERT_NE(door, doorways.end());
  EXPECT_TRUE(door->room_a.valid());
  EXPECT_FALSE(door->room_b.valid());
}

TEST(CutFootprints, UsesTheUncutSolid) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  const uint32_t w = b.Wall("w", {0, 0}, {4, 0}, 0.3);
  b.plan.elements[w].uncut = b.plan.elements[w].body;
  b.plan.elements[w].body = test::Prism(test::Rectangle({0, -0.15}, {1, 0.15}), 0, 2.5);
  DiagnosticSink sink;
  EXPECT_NEAR(RegionArea(Cut(b.plan, sink).floors[0].footprints[0].rings), 1.2, 1e-9);
}

TEST(CutFootprints, LowWallsBoundRoomsOnlyUnderARoof) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  b.Wall("parapet", {0, 0}, {4, 0}, 0.3, 0, 0.9);
  b.Wall("knee", {0, 9}, {4, 9}, 0.3, 0, 0.9);
  b.Prismatic(ElementKind::kRoof, "roof", test::Rectangle({-1, 8}, {5, 10}), 1.0, 1.2);
  b.Wall("hanging", {0, 5}, {4, 5}, 0.3, 2.1, 2.5);
  DiagnosticSink sink;
  const FloorIr floors = Cut(b.plan, sink);
  ASSERT_EQ(floors.floors[0].footprints.size(), 3u);
  EXPECT_FALSE(floors.floors[0].footprints[0].bounds_rooms);
  EXPECT_TRUE(floors.floors[0].footprints[1].bounds_rooms);
  EXPECT_EQ(floors.floors[0].cut_heights_m, (std::vector<double>{0.45, 1.1}));
  EXPECT_FALSE(floors.floors[0].footprints[2].bounds_rooms);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kWallOffSection), 2u);
}

TEST(CutFootprints, PostsOfACurtainWallStandInABand) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  for (double x : {0.0, 1.5, 3.0}) b.Prismatic(ElementKind::kCurtainWall, "curtain", test::Rectangle({x, 0}, {x + 0.05, 0.15}), 0, 2.5);
  // Round a corner: no rectangle, but a rail along the foot.
  for (double x : {0.0, 3.0}) b.Prismatic(ElementKind::kCurtainWall, "corner", test::Rectangle({x, 5}, {x + 0.1, 5.1}), 0, 2.5);
  b.Prismatic(ElementKind::kCurtainWall, "corner", test::Rectangle({3.0, 8}, {3.1, 8.1}), 0, 2.5);
  b.Prismatic(ElementKind::kCurtainWall, "corner", {{0, 5}, {3.1, 5}, {3.1, 8.1}, {3, 8.1}, {3, 5.1}, {0, 5.1}}, 0, 0.05);
  DiagnosticSink sink;
  const FloorIr floors = Cut(b.plan, sink);
  ASSERT_EQ(floors.floors[0].footprints.size(), 2u);
  EXPECT_NEAR(RegionArea(floors.floors[0].footprints[0].rings), 3.05 * 0.15, 1e-6);
  EXPECT_NEAR(RegionArea(floors.floors[0].footprints[1].rings), 3.1 * 0.1 + 3.0 * 0.1, 1e-6);
}

TEST(CutFootprints, WallsWithoutSolidAreLeftOutAndOpenOnesDiagnosed) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  const uint32_t empty = b.Wall("empty", {0, 0}, {4, 0}, 0.3), open = b.Wall("open", {0, 2}, {4, 2}, 0.3);
  b.plan.elements[empty].body = {};
  b.plan.elements[open].body.triangles.erase(b.plan.elements[open].body.triangles.begin());
  b.plan.elements[open].body.triangles.erase(b.plan.elements[open].body.triangles.begin());
  DiagnosticSink sink;
  const FloorIr floors = Cut(b.plan, sink);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kFootprintOpen), 1u);
  ASSERT_EQ(floors.walls.size(), 1u);
  EXPECT_NEAR(RegionArea(floors.floors[0].footprints[0].rings), 1.2, 1e-3);
}

}  // namespace
}  // namespace plumb::compiler
