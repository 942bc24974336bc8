#include "compiler/passes/doorways.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/plan_builder.h"
#include "tests/unit/compiler/passes/build.h"

namespace plumb::compiler {
namespace {

const Doorway* FindDoorway(const AGraph& graph, const std::string& guid) {
  for (const Doorway& d : graph.doorways) {
    if (d.guid == guid) return &d;
  }
  return nullptr;
}

std::string RoomName(const AGraph& graph, RoomId id) { return id.valid() ? graph.rooms[id.index()].name : "outside"; }

TEST(Doorways, JoinTwoRoomsOrARoomAndTheOutside) {
  const AGraph graph = Build(test::TwoRooms()).graph;
  ASSERT_EQ(graph.doorways.size(), 2u);
  const Doorway *d = FindDoorway(graph, "D"), *e = FindDoorway(graph, "E");
  ASSERT_TRUE(d != nullptr && e != nullptr);
  EXPECT_EQ(RoomName(graph, d->room_a), "West");
  EXPECT_EQ(RoomName(graph, d->room_b), "East");
  EXPECT_TRUE(d->position.isApprox(Eigen::Vector3d(5, 1.5, 0), 1e-9));
  EXPECT_NEAR(d->yaw_rad, 0, 1e-9);
  EXPECT_NEAR(d->width_m, 0.9, 1e-9);
  EXPECT_NEAR(d->height_m, 2.1, 1e-9);
  EXPECT_TRUE(d->has_leaf);
  EXPECT_EQ(RoomName(graph, e->room_a), "West");
  EXPECT_FALSE(e->room_b.valid());
  EXPECT_TRUE(e->position.isApprox(Eigen::Vector3d(2, -0.15, 0), 1e-9));
  EXPECT_NEAR(e->yaw_rad, -std::numbers::pi / 2, 1e-9);
  EXPECT_EQ(graph.walls[e->wall.index()].guid, "south");
}

TEST(Doorways, LeavesKnowTheirDoorwayAndWall) {
  const AGraph graph = Build(test::TwoRooms()).graph;
  for (const Element& e : graph.elements) {
    if (e.kind == ElementKind::kDoor) {
      ASSERT_TRUE(e.doorway.valid());
      EXPECT_EQ(graph.doorways[e.doorway.index()].guid, e.guid);
      EXPECT_EQ(graph.doorways[e.doorway.index()].wall, e.wall);
    }
    if (e.kind == ElementKind::kWall) {
      EXPECT_EQ(graph.walls[e.wall.index()].guid, e.guid);
    }
  }
}

PlanLeaf Swing(const Eigen::Vector2d& to_jamb, const Eigen::Vector2d& opens_to, double width_m = 0) {
  return {LeafOperation::kSwing, to_jamb, opens_to, width_m};
}

DoorLeaf Swing(Jamb jamb, DoorwaySide opens_to, double width_m = 0) { return {LeafOperation::kSwing, jamb, opens_to, width_m}; }

// TwoRooms; "D" leads from West to East along +x, "E" from West to the outside along -y.
PlanIr WithLeaves(const std::vector<PlanLeaf>& of_d, const std::vector<PlanLeaf>& of_e) {
  PlanIr plan = test::TwoRooms();
  for (PlanElement& e : plan.elements) {
    if (e.guid == "D") e.leaves = of_d;
    if (e.guid == "E") e.leaves = of_e;
  }
  return plan;
}

TEST(Doorways, LeavesAreToldInTheDoorwaysOwnTerms) {
  const AGraph graph = Build(WithLeaves({Swing({0, -1}, {1, 0}, 0.3), Swing({0, 1}, {-1, 0}, 0.6)}, {Swing({1, 0}, {0, 1})})).graph;
  const std::vector<DoorLeaf> of_d = {Swing(Jamb::kLeft, DoorwaySide::kRoomA, 0.6), Swing(Jamb::kRight, DoorwaySide::kRoomB, 0.3)};
  EXPECT_EQ(FindDoorway(graph, "D")->leaves, of_d);
  // Going out, to the south, east is on the left.
  EXPECT_EQ(FindDoorway(graph, "E")->leaves, std::vector<DoorLeaf>{Swing(Jamb::kLeft, DoorwaySide::kRoomA)});
}

TEST(Doorways, WhatLeavesPointAskewToIsUnknown) {
  const AGraph graph = Build(WithLeaves({Swing({1, 0}, {0, 1})}, {})).graph;
  EXPECT_EQ(FindDoorway(graph, "D")->leaves, std::vector<DoorLeaf>{Swing(Jamb::kUnknown, DoorwaySide::kUnknown)});
  EXPECT_TRUE(FindDoorway(graph, "E")->leaves.empty());
}

// The room that the door's one leaf opens into, and the jamb as seen on the way there: the same whichever room is the first.
std::pair<std::string, bool> InThere(const AGraph& graph, const char* guid) {
  const Doorway* d = FindDoorway(graph, guid);
  if (d == nullptr || d->leaves.size() != 1) return {"none", false};
  const bool to_b = d->leaves[0].opens_to == DoorwaySide::kRoomB;
  return {RoomName(graph, to_b ? d->room_b : d->room_a), (d->leaves[0].jamb == Jamb::kLeft) == to_b};
}

TEST(Doorways, NeitherMotionNorOrderChangesTheLeaves) {
  const PlanIr plan = WithLeaves({Swing({0, -1}, {1, 0})}, {Swing({1, 0}, {0, 1})});
  const std::pair<std::string, bool> d = {"East", false}, e = {"West", false};
  EXPECT_EQ(InThere(Build(plan).graph, "D"), d);
  EXPECT_EQ(InThere(Build(plan).graph, "E"), e);
  for (const double yaw_rad : {0.3, 1.9, -2.6}) {
    const AGraph moved = Build(test::Moved(plan, yaw_rad, {40, -7, 3})).graph;
    EXPECT_EQ(InThere(moved, "D"), d) << yaw_rad;
    EXPECT_EQ(InThere(moved, "E"), e) << yaw_rad;
  }
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    const AGraph other = Build(test::Shuffled(plan, seed)).graph;
    EXPECT_EQ(InThere(other, "D"), d) << seed;
    EXPECT_EQ(InThere(other, "E"), e) << seed;
  }
}

TEST(Windows, LieOnTheirWallAndLookOut) {
  const AGraph graph = Build(test::TwoRooms()).graph;
  ASSERT_EQ(graph.windows.size(), 1u);
  EXPECT_TRUE(graph.windows[0].position.isApprox(Eigen::Vector3d(8.15, 2, 0.9), 1e-9));
  EXPECT_NEAR(graph.windows[0].yaw_rad, 0, 1e-9);
  EXPECT_NEAR(graph.windows[0].width_m, 1.2, 1e-9);
  EXPECT_EQ(graph.walls[graph.windows[0].wall.index()].guid, "east");
}

// TwoRooms with one more opening in the inner wall.
AGraph WithOpening(double along_m, double width_m, double z_min_m, double z_max_m, double depth_m = 0.22) {
  PlanIr plan = test::TwoRooms();
  PlanOpening o;
  o.guid = "hole";
  o.wall = 4;  // inner
  o.body = test::Prism(test::Rectangle({5.11 - depth_m, along_m - width_m / 2}, {5.11, along_m + width_m / 2}), z_min_m, z_max_m);
  plan.openings.push_back(o);
  return Build(plan).graph;
}

TEST(Doorways, AnUnfilledOpeningToTheFloorIsOneWithoutLeaf) {
  const AGraph graph = WithOpening(3.2, 1.4, 0, 2.2);
  EXPECT_EQ(graph.rooms.size(), 2u);
  const Doorway* d = FindDoorway(graph, "hole");
  ASSERT_TRUE(d != nullptr);
  EXPECT_FALSE(d->has_leaf);
  EXPECT_NEAR(d->width_m, 1.4, 1e-9);
  EXPECT_EQ(RoomName(graph, d->room_b), "East");
}

TEST(Doorways, HatchesNichesAndSlitsAreNone) {
  EXPECT_EQ(FindDoorway(WithOpening(3.2, 1.4, 0.9, 2.2), "hole"), nullptr);
  EXPECT_EQ(FindDoorway(WithOpening(3.2, 1.4, 0, 1.2), "hole"), nullptr);
  EXPECT_EQ(FindDoorway(WithOpening(3.2, 0.2, 0, 2.2), "hole"), nullptr);
  EXPECT_EQ(FindDoorway(WithOpening(3.2, 1.4, 0, 2.2, 0.1), "hole"), nullptr);
}

TEST(Doorways, ADoorWithoutOpeningIsHostedByGeometry) {
  PlanIr plan = test::TwoRooms();
  std::erase_if(plan.openings, [](const PlanOpening& o) { return o.guid == "opening-D"; });
  const AGraph bare = Build(plan).graph;
  const Doorway* d = FindDoorway(bare, "D");
  ASSERT_TRUE(d != nullptr);
  EXPECT_EQ(bare.walls[d->wall.index()].guid, "inner");
  EXPECT_EQ(RoomName(bare, d->room_b), "East");
  EXPECT_TRUE(d->position.isApprox(Eigen::Vector3d(5, 1.5, 0), 1e-9));

  // The same, stated as an opening without void and wall.
  const auto door = std::find_if(plan.elements.begin(), plan.elements.end(), [](const PlanElement& e) { return e.guid == "D"; });
  PlanOpening chain;
  chain.filling = static_cast<uint32_t>(door - plan.elements.begin());
  chain.width_m = 0.95;
  plan.openings.push_back(chain);
  const AGraph stated = Build(plan).graph;
  ASSERT_EQ(stated.doorways.size(), 2u);
  EXPECT_NEAR(FindDoorway(stated, "D")->width_m, 0.95, 1e-9);
  EXPECT_EQ(RoomName(stated, FindDoorway(stated, "D")->room_a), "West");
}

TEST(Doorways, ALooseDoorInAnUnfilledOpeningFillsIt) {
  PlanIr plan = test::TwoRooms();
  for (PlanOpening& o : plan.openings) {
    if (o.guid == "opening-D") o.filling = kNoIndex;
  }
  const AGraph graph = Build(plan).graph;
  ASSERT_EQ(graph.doorways.size(), 2u);
  const Doorway* d = FindDoorway(graph, "D");
  ASSERT_TRUE(d != nullptr);
  EXPECT_TRUE(d->has_leaf);
}

TEST(Doorways, DoublewalledPassagesReachTheRoomBehind) {
  PlanIr plan = test::TwoRooms();
  test::PlanBuilder b;
  b.plan = plan;
  b.On(0).Prismatic(ElementKind::kWall, "second skin", test::Rectangle({5.15, 0}, {5.3, 4}), 0, 2.5);  // 5 cm cavity
  const AGraph graph = Build(b.plan).graph;
  EXPECT_EQ(graph.rooms.size(), 2u);
  EXPECT_EQ(RoomName(graph, FindDoorway(graph, "D")->room_b), "East");
}

TEST(Doorways, OnesThatLeadNowhereAreDiagnosed) {
  PlanIr plan = test::TwoRooms();
  test::PlanBuilder b;
  b.plan = plan;
  b.On(0);
  const uint32_t stub = b.Wall("stub", {1, 2}, {3, 2}, 0.1), garden = b.Wall("garden", {20, 2}, {23, 2}, 0.1);
  PlanElement leaf = plan.elements[5];
  ASSERT_EQ(leaf.kind, ElementKind::kDoor);
  const auto add = [&](const std::string& guid, uint32_t wall, const Eigen::Vector2d& lo, const Eigen::Vector2d& hi) {
    leaf.guid = guid;
    leaf.body = test::Prism(test::Rectangle(lo, hi), 0, 2.1);
    b.plan.elements.push_back(leaf);
    PlanOpening o;
    o.wall = wall;
    o.filling = static_cast<uint32_t>(b.plan.elements.size() - 1);
    o.body = leaf.body;
    b.plan.openings.push_back(o);
  };
  add("within", stub, {1.5, 1.9}, {2.4, 2.1});
  add("gate", garden, {21, 1.9}, {22, 2.1});
  add("lone", kNoIndex, {30, 30}, {31, 30.1});
  DiagnosticSink sink;
  const AGraph graph = Build(b.plan, sink).graph;
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kDoorwayWithinRoom), 1u);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kDoorwayOutside), 2u);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kOpeningWithoutWall), 1u);
  EXPECT_EQ(FindDoorway(graph, "within")->room_a, FindDoorway(graph, "within")->room_b);
  EXPECT_FALSE(FindDoorway(graph, "lone")->wall.valid());
  EXPECT_NEAR(FindDoorway(graph, "lone")->width_m, 1, 1e-9);
}

// Tilted by 30 deg and tied to nothing, or upright in an opening of a slab.
TEST(Windows, InARoofAreSaidAndLeftOut) {
  test::PlanBuilder b;
  b.plan = test::TwoRooms();
  b.On(0);
  PlanElement light;
  light.kind = ElementKind::kWindow;
  light.guid = "skylight";
  light.body = MakeBox({0, 0, 0}, {0.8, 1.2, 0.05},
                       Eigen::Affine3d(Eigen::Translation3d(2, 1.5, 2.6) * Eigen::AngleAxisd(0.52, Eigen::Vector3d::UnitX())));
  b.plan.elements.push_back(light);
  const uint32_t slab = b.Prismatic(ElementKind::kSlab, "roof", test::Rectangle({-1, -1}, {9, 5}), 2.5, 2.7);
  light.guid = "lantern";
  light.body = test::Prism(test::Rectangle({6, 2}, {6.1, 3}), 2.5, 3.5);
  b.plan.elements.push_back(light);
  PlanOpening o;
  o.wall = slab;
  o.filling = static_cast<uint32_t>(b.plan.elements.size() - 1);
  o.body = light.body;
  b.plan.openings.push_back(o);
  DiagnosticSink sink;
  const AGraph graph = Build(b.plan, sink).graph;
  ASSERT_EQ(graph.windows.size(), 1u);
  EXPECT_EQ(graph.windows[0].guid, "W");
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kWindowInRoof), 2u);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kOpeningWithoutWall), 0u);
}

TEST(Doorways, OnTheUpperStoreyJoinItsRooms) {
  PlanIr plan = test::TwoRooms();
  PlanIr upper = test::Moved(plan, 0, {0, 0, 2.7});
  plan.storeys.push_back({"up", "Upper", {}, 2.7});
  const auto base = static_cast<uint32_t>(plan.elements.size());
  for (PlanElement e : upper.elements) {
    e.guid += "-up";
    e.storey = 1;
    plan.elements.push_back(e);
  }
  for (PlanOpening o : upper.openings) {
    o.wall += base;
    o.filling += base;
    plan.openings.push_back(o);
  }
  const AGraph graph = Build(plan).graph;
  ASSERT_EQ(graph.rooms.size(), 4u);
  const Doorway* d = FindDoorway(graph, "D-up");
  ASSERT_TRUE(d != nullptr);
  EXPECT_EQ(d->storey, StoreyId(1));
  EXPECT_EQ(graph.rooms[d->room_a.index()].storey, StoreyId(1));
  EXPECT_EQ(graph.rooms[d->room_b.index()].storey, StoreyId(1));
  EXPECT_NEAR(d->position.z(), 2.7, 1e-9);
}

TEST(Doorways, AVoidThatReachesFarBeyondItsWallIsPlacedInTheWall) {
  PlanIr plan = test::TwoRooms();
  // The inner door's void reaches 3 m to the west.
  for (PlanOpening& o : plan.openings) {
    if (o.guid == "opening-D") o.body = test::Prism(test::Rectangle({2, 1.05}, {5.11, 1.95}), 0, 2.1);
  }
  const AGraph graph = Build(plan).graph;
  const auto door = std::find_if(graph.doorways.begin(), graph.doorways.end(), [](const Doorway& d) { return d.guid == "D"; });
  ASSERT_NE(door, graph.doorways.end());
  ASSERT_TRUE(door->wall.valid());
  EXPECT_EQ(graph.walls[door->wall.index()].guid, "inner");
  EXPECT_TRUE((door->position.head<2>() - Eigen::Vector2d(5, 1.5)).norm() < 1e-6);
  EXPECT_NEAR(door->width_m, 0.9, 1e-6);
  EXPECT_TRUE(door->room_a.valid() && door->room_b.valid());
}

}  // namespace
}  // namespace plumb::compiler
