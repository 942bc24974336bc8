#include "compiler/passes/rooms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "compiler/passes/polygon.h"
#include "tests/support/plan_builder.h"
#include "tests/unit/compiler/passes/build.h"

namespace plumb::compiler {
namespace {

TEST(FindRooms, TwoRoomsAndADoor) {
  const AGraph graph = Build(test::TwoRooms()).graph;
  ASSERT_EQ(graph.rooms.size(), 2u);
  const Room *west = FindRoom(graph, "West"), *east = FindRoom(graph, "East");
  ASSERT_TRUE(west != nullptr && east != nullptr);
  EXPECT_NEAR(west->area_m2, 4.9 * 4, 1e-9);
  EXPECT_NEAR(east->area_m2, 2.9 * 4, 1e-9);
  EXPECT_EQ(west->polygon.size(), 4u);
  EXPECT_TRUE(west->center.isApprox(Eigen::Vector3d(2.45, 2, 0), 1e-9));
  EXPECT_DOUBLE_EQ(west->floor_z_m, 0);
  EXPECT_DOUBLE_EQ(west->ceiling_z_m, 2.5);
  EXPECT_EQ(west->guid, "space-West");
}

// Some files have the roof or the site as a storey at zero, just below the ground floor.
TEST(FindRooms, AStoreyWithoutWallsHasNoRoomsIfOneCloseByHasWalls) {
  test::PlanBuilder b;
  b.plan = test::TwoRooms();
  PlanStorey roof = b.plan.storeys[0];
  roof.name = "Roof";
  b.plan.storeys[0].elevation_m = 0.18;
  b.plan.storeys.insert(b.plan.storeys.begin(), roof);
  for (PlanElement& e : b.plan.elements) ++e.storey;
  for (PlanSpace& s : b.plan.spaces) ++s.storey;
  const AGraph graph = Build(b.plan).graph;
  ASSERT_EQ(graph.rooms.size(), 2u);
  for (const Room& room : graph.rooms) {
    EXPECT_DOUBLE_EQ(room.floor_z_m, 0) << "nearer to the roof's zero";
    EXPECT_EQ(graph.storeys[room.storey.index()].name, graph.storeys[graph.walls[0].storey.index()].name);
    EXPECT_NE(graph.storeys[room.storey.index()].name, "Roof");
  }
}

TEST(FindRooms, AnLShapedRoomHasSixCorners) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  b.Wall("s", {-0.2, -0.1}, {6.2, -0.1}, 0.2);
  b.Wall("e", {6.1, 0}, {6.1, 2}, 0.2);
  b.Wall("n1", {6.2, 2.1}, {3, 2.1}, 0.2);
  b.Wall("e2", {3.1, 2.2}, {3.1, 5}, 0.2);
  b.Wall("n2", {3.2, 5.1}, {-0.2, 5.1}, 0.2);
  b.Wall("w", {-0.1, 5}, {-0.1, 0}, 0.2);
  const AGraph graph = Build(b.plan).graph;
  ASSERT_EQ(graph.rooms.size(), 1u);
  EXPECT_EQ(graph.rooms[0].polygon.size(), 6u);
  EXPECT_NEAR(graph.rooms[0].area_m2, 6 * 2 + 3 * 3, 1e-9);
  EXPECT_NEAR(graph.rooms[0].yaw_rad, 0, 1e-9);
}

// A box of this inner size in the north-west corner of the two rooms, with or without a door to it.
PlanIr WithCorner(double size_m, bool door) {
  test::PlanBuilder b;
  b.plan = test::TwoRooms();
  b.plan.spaces.clear();
  b.On(0);
  const uint32_t south = b.Wall("corner_s", {0, 4 - size_m - 0.05}, {size_m + 0.1, 4 - size_m - 0.05}, 0.1);
  b.Wall("corner_e", {size_m + 0.05, 4 - size_m}, {size_m + 0.05, 4}, 0.1);
  if (door) b.Door("corner_d", south, 0.5 * size_m, 0.5);
  return b.plan;
}

TEST(FindRooms, AClosetWithADoorIsARoom) {
  EXPECT_EQ(Build(WithCorner(0.6, true)).graph.rooms.size(), 3u);
  EXPECT_EQ(Build(WithCorner(1.1, true)).graph.rooms.size(), 3u);
}

TEST(FindRooms, ABoxedCornerWithoutADoorIsAShaft) {
  EXPECT_EQ(Build(WithCorner(0.6, false)).graph.rooms.size(), 2u);
  EXPECT_EQ(Build(WithCorner(1.1, false)).graph.rooms.size(), 2u);
}

TEST(FindRooms, ASmallRoomThatTheSourceNamesIsOneWithoutADoor) {
  test::PlanBuilder b;
  b.plan = WithCorner(1.1, false);
  b.On(0).Space("Safe", test::Rectangle({0, 2.9}, {1.1, 4}));
  const AGraph graph = Build(b.plan).graph;
  EXPECT_EQ(graph.rooms.size(), 3u);
  EXPECT_NE(FindRoom(graph, "Safe"), nullptr);
}

TEST(FindRooms, ALargerRoomNeedsNoDoor) { EXPECT_EQ(Build(WithCorner(1.5, false)).graph.rooms.size(), 3u); }

TEST(FindRooms, FreeStandingWallsAndColumnsAreHoles) {
  PlanIr plan = test::TwoRooms();
  test::PlanBuilder b;
  b.plan = plan;
  b.On(0).Prismatic(ElementKind::kColumn, "column", test::Rectangle({1, 1}, {1.4, 1.4}), 0, 2.5);
  b.Prismatic(ElementKind::kWall, "screen", test::Rectangle({2, 3}, {3, 3.1}), 0, 2.5);
  const AGraph graph = Build(b.plan).graph;
  const Room* west = FindRoom(graph, "West");
  ASSERT_TRUE(west != nullptr);
  ASSERT_EQ(west->holes.size(), 2u);
  for (const Ring& hole : west->holes) EXPECT_LT(SignedArea(hole), 0);
  EXPECT_NEAR(west->area_m2, 4.9 * 4 - 0.16 - 0.1, 1e-9);
  ASSERT_EQ(graph.columns.size(), 1u);
  EXPECT_NEAR(SignedArea(graph.columns[0].outline), 0.16, 1e-9);
  EXPECT_EQ(west->surfaces.size(), 4u + 4u);  // a column owns no surface
}

TEST(FindRooms, MitredCornersGiveTheSameRoom) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  const double t = 0.3;
  b.Prismatic(ElementKind::kWall, "s", {{-t, -t}, {4 + t, -t}, {4, 0}, {0, 0}}, 0, 2.5);
  b.Prismatic(ElementKind::kWall, "e", {{4 + t, -t}, {4 + t, 3 + t}, {4, 3}, {4, 0}}, 0, 2.5);
  b.Prismatic(ElementKind::kWall, "n", {{4 + t, 3 + t}, {-t, 3 + t}, {0, 3}, {4, 3}}, 0, 2.5);
  b.Prismatic(ElementKind::kWall, "w", {{-t, 3 + t}, {-t, -t}, {0, 0}, {0, 3}}, 0, 2.5);
  const Built built = Build(b.plan);
  ASSERT_EQ(built.graph.rooms.size(), 1u);
  EXPECT_NEAR(built.graph.rooms[0].area_m2, 12, 1e-9);
  EXPECT_EQ(built.floors.floors[0].faces.size(), 6u);
  const Wall* south = FindWall(built.graph, "s");
  EXPECT_NEAR(south->thickness_m, 0.3, 1e-9);
  EXPECT_NEAR((south->axis_end - south->axis_start).norm(), 4.3, 1e-9);
  EXPECT_TRUE(south->external);
}

TEST(FindRooms, CurvedWallAsFacetsClosesARoom) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  const int n = 24;
  Ring inner, outer;
  for (int i = 0; i <= n; ++i) {
    const double a = std::numbers::pi * i / n;
    inner.emplace_back(3 * std::cos(a), 3 * std::sin(a));
    outer.emplace_back(3.2 * std::cos(a), 3.2 * std::sin(a));
  }
  Ring ring = outer;
  ring.insert(ring.end(), inner.rbegin(), inner.rend());
  const uint32_t bow = b.Prismatic(ElementKind::kWall, "bow", ring, 0, 2.5);
  b.plan.elements[bow].arcs = {{{0, 0}, 3, 0, std::numbers::pi}, {{0, 0}, 3.2, 0, std::numbers::pi}};
  b.Wall("chord", {-3.2, -0.1}, {3.2, -0.1}, 0.2);
  const AGraph graph = Build(b.plan).graph;
  ASSERT_EQ(graph.rooms.size(), 1u);
  EXPECT_NEAR(graph.rooms[0].area_m2, 0.5 * n * 9 * std::sin(std::numbers::pi / n), 1e-2);
  EXPECT_EQ(graph.rooms[0].polygon.size(), static_cast<size_t>(n) + 1);
  const Wall* wall = FindWall(graph, "bow");
  EXPECT_NEAR(wall->thickness_m, 0.2, 1e-9);
  // One surface for the whole arc, seen from within: counter-clockwise.
  ASSERT_EQ(graph.rooms[0].surfaces.size(), 2u);
  const Surface& s0 = graph.surfaces[graph.rooms[0].surfaces[0].index()];
  const Surface& curved = s0.arc ? s0 : graph.surfaces[graph.rooms[0].surfaces[1].index()];
  ASSERT_TRUE(curved.arc.has_value());
  EXPECT_NEAR(curved.arc->radius_m, 3, 1e-9);
  EXPECT_NEAR(curved.arc->sweep_rad, std::numbers::pi, 1e-6);
  EXPECT_NEAR(curved.arc->start_rad, 0, 1e-6);
  EXPECT_NEAR(curved.normal.y(), -1, 1e-9);
}

TEST(FindRooms, ShaftsCavitiesAndCrawlSpacesAreNoRooms) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  const auto box = [&b](const std::string& name, Eigen::Vector2d lo, Eigen::Vector2d hi, double height) {
    b.Wall(name + "s", {lo.x(), lo.y() - 0.1}, {hi.x() + 0.2, lo.y() - 0.1}, 0.2, 0, height);
    b.Wall(name + "e", {hi.x() + 0.1, lo.y()}, {hi.x() + 0.1, hi.y() + 0.2}, 0.2, 0, height);
    b.Wall(name + "n", {hi.x(), hi.y() + 0.1}, {lo.x() - 0.2, hi.y() + 0.1}, 0.2, 0, height);
    b.Wall(name + "w", {lo.x() - 0.1, hi.y()}, {lo.x() - 0.1, lo.y() - 0.2}, 0.2, 0, height);
  };
  box("shaft", {0, 0}, {0.6, 0.6}, 2.5);
  box("cavity", {10, 0}, {10.08, 20}, 2.5);
  box("crawl", {20, 0}, {24, 4}, 1.3);
  b.Prismatic(ElementKind::kSlab, "lid", test::Rectangle({19, -1}, {25, 5}), 1.3, 1.5);
  box("room", {30, 0}, {34, 4}, 2.5);
  DiagnosticSink sink;
  const AGraph graph = Build(b.plan, sink).graph;
  ASSERT_EQ(graph.rooms.size(), 1u);
  EXPECT_NEAR(graph.rooms[0].center.x(), 32, 1e-9);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kRoomTooLow), 1u);
}

// A hall two storeys high on the left, rooms on both storeys on the right.
test::PlanBuilder Hall() {
  test::PlanBuilder b;
  b.Storey("Ground", 0);
  b.Wall("s", {-0.2, -0.1}, {8.2, -0.1}, 0.2, 0, 6);
  b.Wall("n", {-0.2, 4.1}, {8.2, 4.1}, 0.2, 0, 6);
  b.Wall("w", {-0.1, 0}, {-0.1, 4}, 0.2, 0, 6);
  b.Wall("e", {8.1, 0}, {8.1, 4}, 0.2, 0, 6);
  b.Wall("inner", {4, 0}, {4, 4}, 0.2, 0, 6);
  b.Prismatic(ElementKind::kSlab, "floor", test::Rectangle({-0.2, -0.2}, {8.2, 4.2}), -0.2, 0);
  b.Prismatic(ElementKind::kSlab, "ceiling", test::Rectangle({4, -0.2}, {8.2, 4.2}), 2.8, 3);
  b.Prismatic(ElementKind::kRoof, "roof", test::Rectangle({-0.2, -0.2}, {8.2, 4.2}), 6, 6.2);
  b.Storey("Upper", 3);
  return b;
}

TEST(FindRooms, TheUpperPartOfAHallIsNoRoomOfItsOwn) {
  DiagnosticSink sink;
  const AGraph graph = Build(Hall().plan, sink).graph;
  ASSERT_EQ(graph.rooms.size(), 3u);
  EXPECT_EQ(std::count_if(graph.rooms.begin(), graph.rooms.end(), [](const Room& r) { return r.storey == StoreyId(1); }), 1);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kVoidOverRoom), 1u);
}

TEST(FindRooms, AStairwellWithADoorOnTheUpperStoreyIsARoomThere) {
  test::PlanBuilder b = Hall();
  b.Door("D", 4, 2, 0.9, 3, 5.1);
  const AGraph graph = Build(b.plan).graph;
  EXPECT_EQ(std::count_if(graph.rooms.begin(), graph.rooms.end(), [](const Room& r) { return r.storey == StoreyId(1); }), 2);
}

TEST(FindRooms, UpperStoreysWithoutSlabsKeepTheirRooms) {
  PlanIr plan = Hall().plan;
  std::erase_if(plan.elements, [](const PlanElement& e) { return e.guid == "ceiling"; });
  EXPECT_EQ(Build(plan).graph.rooms.size(), 4u);
}

TEST(FindRooms, HeightsComeFromSlabsAndFallBackToStoreys) {
  PlanIr plan = test::TwoRooms();
  plan.storeys.push_back({"", "Upper", {}, 2.7});
  const AGraph with = Build(plan).graph;
  EXPECT_DOUBLE_EQ(with.rooms[0].ceiling_z_m, 2.5);
  std::erase_if(plan.elements, [](const PlanElement& e) { return e.kind == ElementKind::kSlab; });
  const AGraph without = Build(plan).graph;
  EXPECT_DOUBLE_EQ(without.rooms[0].floor_z_m, 0);
  EXPECT_DOUBLE_EQ(without.rooms[0].ceiling_z_m, 2.7);
  EXPECT_DOUBLE_EQ(without.storeys[0].height_m, 2.7);
}

// On the left a stair hall, open to below but for the landing before its door; the storey's zero is not what one walks on.
TEST(FindRooms, AStairHallStandsAtTheHeightBeforeItsDoors) {
  const auto hall_floor_m = [](bool landing) {
    test::PlanBuilder b;
    b.Storey("Ground", 0);
    b.Wall("s", {-0.2, -0.1}, {8.2, -0.1}, 0.2, 0, 3);
    b.Wall("n", {-0.2, 4.1}, {8.2, 4.1}, 0.2, 0, 3);
    b.Wall("w", {-0.1, 0}, {-0.1, 4}, 0.2, 0, 3);
    b.Wall("e", {8.1, 0}, {8.1, 4}, 0.2, 0, 3);
    b.Door("D", b.Wall("inner", {4, 0}, {4, 4}, 0.2, 0, 3), 2, 0.9, 0.18, 2.2);
    b.Prismatic(ElementKind::kSlab, "floor", test::Rectangle({4, -0.2}, {8.2, 4.2}), 0, 0.18);
    if (landing) b.Prismatic(ElementKind::kSlab, "landing", test::Rectangle({2.9, 0}, {4, 4}), 0, 0.18);
    const AGraph graph = Build(b.plan).graph;
    EXPECT_EQ(graph.rooms.size(), 2u);
    const bool first_is_hall = graph.rooms.at(0).center.x() < 4;
    EXPECT_DOUBLE_EQ(graph.rooms.at(first_is_hall ? 1 : 0).floor_z_m, 0.18);
    return graph.rooms.at(first_is_hall ? 0 : 1).floor_z_m;
  };
  EXPECT_DOUBLE_EQ(hall_floor_m(true), 0.18);
  EXPECT_DOUBLE_EQ(hall_floor_m(false), 0) << "no floor before its door either: the storey's zero";
}

TEST(FindRooms, AFlightOfStairsWithRoomBelowItIsACeiling) {
  const auto ceiling_m = [](const std::vector<std::pair<double, double>>& flights_m) {
    test::PlanBuilder b;
    b.plan = test::TwoRooms();
    b.On(0);
    for (const auto& [from_m, to_m] : flights_m)
      b.Prismatic(ElementKind::kStair, "flight", test::Rectangle({0, 0}, {4.9, 3}), from_m, to_m);
    const AGraph graph = Build(b.plan).graph;
    const Room* west = FindRoom(graph, "West");
    return west != nullptr ? west->ceiling_z_m : 0;
  };
  EXPECT_DOUBLE_EQ(ceiling_m({{2.0, 2.2}}), 2.0);
  EXPECT_DOUBLE_EQ(ceiling_m({{1.2, 1.4}}), 2.5) << "nobody stands below it";
  EXPECT_DOUBLE_EQ(ceiling_m({{0.0, 0.6}, {2.2, 2.4}}), 2.2) << "seen from the flight below";
  EXPECT_DOUBLE_EQ(ceiling_m({{2.6, 2.8}}), 2.5) << "above the ceiling";
}

}  // namespace
}  // namespace plumb::compiler
