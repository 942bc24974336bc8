#include "compiler/passes/bridge_gaps.h"

#include <gtest/gtest.h>

#include "compiler/passes/face_locator.h"
#include "compiler/passes/polygon.h"
#include "tests/support/plan_builder.h"
#include "tests/unit/compiler/passes/build.h"

namespace plumb::compiler {
namespace {

using test::Rectangle;

// Four walls around [0,4] x [0,3]; the west wall stops `gap_m` short of the north wall.
Floor Box(double gap_m) {
  return FloorOf({Rectangle({-0.2, -0.2}, {4.2, 0}), Rectangle({-0.2, 3}, {4.2, 3.2}), Rectangle({-0.2, 0}, {0, 3 - gap_m}),
                  Rectangle({4, 0}, {4.2, 3})});
}

uint32_t FaceAt(const Floor& floor, const Eigen::Vector2d& p) { return FaceLocator(floor).FaceAt(p); }

TEST(BridgeGaps, AGapThatNobodyPassesIsClosed) {
  for (const double gap : {0.01, 0.1, 0.19}) {
    Floor floor = Box(gap);
    ASSERT_TRUE(BridgeGaps({}, {}, floor));
    EXPECT_EQ(floor.bridges.size(), 2u) << gap;
    const uint32_t room = FaceAt(floor, {2, 1.5});
    ASSERT_NE(room, 0u) << gap;
    EXPECT_NEAR(floor.faces[room].area_m2, 12, 1e-9) << gap;
    for (const BoundaryEdge& e : floor.faces[room].outer) {
      if (e.bridge == kNoIndex) continue;
      EXPECT_EQ(e.footprints, (std::vector<uint32_t>{1, 2}));
    }
  }
}

TEST(BridgeGaps, WallsDrawnManyTimesAreBridgedOnce) {
  const Floor once = Box(0.1);
  Floor often = once;
  for (int copy = 0; copy < 2000; ++copy) often.footprints.insert(often.footprints.end(), once.footprints.begin(), once.footprints.end());
  EXPECT_EQ(FindBridges(often, 0.002, 0.2).size(), FindBridges(once, 0.002, 0.2).size());
}

TEST(BridgeGaps, APassageStaysOpen) {
  Floor floor = Box(0.25);
  ASSERT_TRUE(BridgeGaps({}, {}, floor));
  EXPECT_TRUE(floor.bridges.empty());
  EXPECT_EQ(FaceAt(floor, {2, 1.5}), 0u);
}

TEST(BridgeGaps, SlitsThatKeepNothingApartStayAsDrawn) {
  Floor floor = Box(0);
  floor.footprints.push_back({FootprintKind::kColumn, kNoIndex, 4, true, {Rectangle({0.05, 1}, {0.45, 1.4})}});  // beside the west wall
  floor.footprints.push_back({FootprintKind::kWall, 5, 5, true, {Rectangle({2, 0}, {2.1, 2.9})}});              // a screen up to 0.1 m
  floor.footprints.push_back({FootprintKind::kWall, 6, 6, true, {Rectangle({3, 0.5}, {3.1, 3})}});              // open at its other end
  Floor plain = floor;
  ASSERT_TRUE(BuildPlanarMap(plain, {}));
  ASSERT_TRUE(BridgeGaps({}, {}, floor));
  // The screen does keep the west part from the east part; the column keeps nothing apart.
  EXPECT_NE(FaceAt(floor, {1, 2}), FaceAt(floor, {2.5, 2}));
  EXPECT_EQ(FaceAt(floor, {2.5, 2}), FaceAt(floor, {3.5, 2}));
  EXPECT_EQ(FaceAt(floor, {0.025, 1.2}), FaceAt(floor, {1, 2}));
  EXPECT_EQ(plain.faces.size() + 2, floor.faces.size());  // one room more, and the sliver at the screen's end
}

TEST(BridgeGaps, FewGapsInALargePlanAreDecidedAsInASmallOne) {
  for (const double gap : {0.0, 0.1}) {
    Floor alone = Box(gap);
    alone.footprints.push_back({FootprintKind::kColumn, kNoIndex, 4, true, {Rectangle({0.05, 1}, {0.45, 1.4})}});
    alone.footprints.push_back({FootprintKind::kWall, 5, 5, true, {Rectangle({2, 0}, {2.1, 2.9})}});
    alone.footprints.push_back({FootprintKind::kWall, 6, 6, true, {Rectangle({3, 0.5}, {3.1, 3})}});
    Floor among = alone;
    for (uint32_t i = 0; i < 1000; ++i) {  // columns in the yard, all in one face with the outside
      const Eigen::Vector2d at(10 + i % 40, i / 40);
      among.footprints.push_back({FootprintKind::kColumn, kNoIndex, 7 + i, true, {Rectangle(at, at + Eigen::Vector2d(0.3, 0.3))}});
    }
    ASSERT_LT(20 * FindBridges(among, 0.002, 0.2).size(), among.footprints.size()) << "enough of them to look about the gaps only";
    ASSERT_TRUE(BridgeGaps({}, {}, alone));
    ASSERT_TRUE(BridgeGaps({}, {}, among));
    ASSERT_EQ(among.bridges.size(), alone.bridges.size()) << gap;
    EXPECT_GT(among.bridges.size(), 0u);
    for (size_t b = 0; b < alone.bridges.size(); ++b) {
      EXPECT_EQ(among.bridges[b].from, alone.bridges[b].from);
      EXPECT_EQ(among.bridges[b].to, alone.bridges[b].to);
      EXPECT_EQ(among.bridges[b].footprint_a, alone.bridges[b].footprint_a);
      EXPECT_EQ(among.bridges[b].footprint_b, alone.bridges[b].footprint_b);
    }
    EXPECT_EQ(FaceAt(among, {2.5, 2}), FaceAt(among, {3.5, 2}));
    EXPECT_NE(FaceAt(among, {1, 2}), FaceAt(among, {2.5, 2}));
  }
  Floor open = Box(0.25);  // no gap at all that is narrow enough
  for (uint32_t i = 0; i < 200; ++i)
    open.footprints.push_back({FootprintKind::kColumn, kNoIndex, 7 + i, true, {Rectangle({10.0 + i, 0}, {10.4 + i, 1})}});
  ASSERT_TRUE(BridgeGaps({}, {}, open));
  EXPECT_TRUE(open.bridges.empty());
  EXPECT_EQ(FaceAt(open, {2, 1.5}), 0u);
}

TEST(BridgeGaps, PartsOfOneWallAreBridgedToo) {
  Floor floor = Box(0);
  floor.footprints[0].rings = {Rectangle({-0.2, -0.2}, {1, 0}), Rectangle({1.05, -0.2}, {4.2, 0})};
  ASSERT_TRUE(BridgeGaps({}, {}, floor));
  EXPECT_NE(FaceAt(floor, {2, 1.5}), 0u);
}

TEST(BridgeGaps, SurfacesRunOnOverTheGapAndEachGapIsReportedOnce) {
  PlanIr plan = test::TwoRooms();
  // The inner wall stops 5 cm short of the north wall.
  for (auto& v : plan.elements[4].body.vertices) v.y() = std::min(v.y(), 3.95);
  DiagnosticSink sink;
  const AGraph graph = Build(plan, sink).graph;
  ASSERT_EQ(graph.rooms.size(), 2u);
  EXPECT_NEAR(FindRoom(graph, "West")->area_m2, 4.9 * 4, 1e-9);
  EXPECT_EQ(FindRoom(graph, "West")->surfaces.size(), 4u);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kGapBridged), 1u);
  EXPECT_TRUE(graph.open_boundaries.empty());
}

TEST(BridgeGaps, WithoutARadiusNothingIsBridged) {
  PassOptions options;
  options.bridges.max_gap_m = 0;
  PlanIr plan = test::TwoRooms();
  for (auto& v : plan.elements[4].body.vertices) v.y() = std::min(v.y(), 3.95);
  plan.spaces.clear();
  EXPECT_EQ(Build(plan, options).graph.rooms.size(), 1u);
}

}  // namespace
}  // namespace plumb::compiler
