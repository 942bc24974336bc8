#include "compiler/frontends/drawing/plan_from_drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "compiler/passes/build_agraph.h"

namespace plumb::compiler {
namespace {

void AddRing(const Ring& ring, const std::string& guid, Drawing& drawing) {
  DrawnPath path;
  path.points = ring;
  path.points.push_back(ring.front());
  path.closed = true;
  path.role = LineRole::kWall;
  path.location.guid = guid;
  drawing.paths.push_back(path);
}

// Each from (x, y) to (x, y).
Drawing WallLines(const std::vector<Eigen::Vector4d>& lines) {
  Drawing out;
  for (const Eigen::Vector4d& line : lines) {
    DrawnPath path;
    path.role = LineRole::kWall;
    path.points = {line.head<2>(), line.tail<2>()};
    path.location.guid = std::to_string(out.paths.size());
    out.paths.push_back(path);
  }
  return out;
}

AGraph Compiled(PlanIr plan) {
  DiagnosticSink sink;
  std::optional<Built> built = BuildAGraph(plan, {}, sink);
  EXPECT_TRUE(built.has_value());
  return built ? std::move(built->graph) : AGraph();
}

// A room with an oblique corner that juts into it and one that does not: walls of 0.3 m between two outlines.
TEST(AppendStorey, WallsEndAtObliqueCornersWhereTheDrawingHasThem) {
  const Ring inner = {{0, 0}, {9, 0}, {9, 4}, {6.5, 6.5}, {6.5, 9}, {0, 9}};
  const double c = 0.3 * std::tan(std::numbers::pi / 8);
  const Ring outer = {{-0.3, -0.3}, {9.3, -0.3}, {9.3, 4 + c}, {6.8, 6.5 + c}, {6.8, 9.3}, {-0.3, 9.3}};
  Drawing drawing;
  AddRing(inner, "A", drawing);
  AddRing(outer, "B", drawing);
  PlanIr plan;
  DiagnosticSink sink;
  ASSERT_TRUE(AppendStorey(drawing, {{}, "Ground", {}, 0.0}, {}, plan, sink));
  const AGraph graph = Compiled(plan);
  ASSERT_EQ(graph.rooms.size(), 1u);
  EXPECT_EQ(graph.rooms[0].polygon.size(), inner.size());
  for (const auto& corner : inner) {
    double nearest = 1e9;
    for (const auto& p : graph.rooms[0].polygon) nearest = std::min(nearest, (p - corner).norm());
    EXPECT_LT(nearest, 1e-3) << corner.transpose();
  }
}

// Handles count from one in every file.
TEST(AppendStorey, IdsOfOneStoreyAreNotThoseOfAnother) {
  Drawing drawing;
  AddRing({{0, 0}, {4, 0}, {4, 3}, {0, 3}}, "2F", drawing);
  AddRing({{-0.2, -0.2}, {4.2, -0.2}, {4.2, 3.2}, {-0.2, 3.2}}, "30", drawing);
  PlanIr plan;
  DiagnosticSink sink;
  ASSERT_TRUE(AppendStorey(drawing, {{}, "Ground", {}, 0.0}, {}, plan, sink));
  ASSERT_TRUE(AppendStorey(drawing, {{}, "Upper", {}, 3.0}, {}, plan, sink));
  std::set<std::string> ids;
  for (const PlanElement& e : plan.elements) EXPECT_TRUE(ids.insert(e.guid).second) << e.guid;
  EXPECT_TRUE(ids.contains("2F") || ids.contains("30"));
  EXPECT_TRUE(ids.contains("Upper:2F") || ids.contains("Upper:30"));
  EXPECT_EQ(Compiled(plan).walls.size(), 8u);
}

// Two walls that cross a corridor's ends: the pieces of the outer walls between them are no doors in frames.
TEST(AppendStorey, PiecesOfWallBetweenCrossingWallsAreNoDoors) {
  const Drawing drawing = WallLines({{0, 0, 10, 0}, {10, 0, 10, 8}, {10, 8, 0, 8}, {0, 8, 0, 0}, {0, 3, 10, 3}, {0, 4.5, 10, 4.5}});
  PlanIr plan;
  DiagnosticSink sink;
  ASSERT_TRUE(AppendStorey(drawing, {{}, "Ground", {}, 0.0}, {}, plan, sink));
  EXPECT_TRUE(plan.openings.empty());
  EXPECT_EQ(Compiled(plan).rooms.size(), 3u);
}

// Two leaves with a post of 6 cm between them, in a wall 0.2 m thick.
TEST(AppendStorey, LeavesThatMeetAtAPostAreOneDoorway) {
  Drawing drawing;
  const auto box = [&](double x0, double y0, double x1, double y1) {
    AddRing({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, std::to_string(drawing.paths.size()), drawing);
  };
  box(-0.2, -0.2, 2, 0);
  box(2.9, -0.2, 2.96, 0);
  box(3.86, -0.2, 6.2, 0);
  box(-0.2, 0, 0, 4.2);
  box(6, 0, 6.2, 4.2);
  box(0, 4, 6, 4.2);
  for (const bool left : {true, false}) {
    DrawnPath swing;
    swing.role = LineRole::kDoor;
    const Eigen::Vector2d hinge(left ? 2 : 3.86, 0);
    swing.arcs.push_back({hinge, 0.9, left ? 0.0 : std::numbers::pi, left ? 0.5 * std::numbers::pi : -0.5 * std::numbers::pi});
    for (int i = 0; i <= 9; ++i) {
      const double a = swing.arcs[0].start_rad + swing.arcs[0].sweep_rad * i / 9;
      swing.points.push_back(hinge + 0.9 * Eigen::Vector2d(std::cos(a), std::sin(a)));
    }
    drawing.paths.push_back(swing);
  }
  PlanIr plan;
  DiagnosticSink sink;
  ASSERT_TRUE(AppendStorey(drawing, {{}, "Ground", {}, 0.0}, {}, plan, sink));
  const AGraph graph = Compiled(plan);
  EXPECT_EQ(graph.rooms.size(), 1u);
  ASSERT_EQ(graph.doorways.size(), 1u);
  EXPECT_NEAR(graph.doorways[0].width_m, 1.86, 1e-3);
  EXPECT_NEAR(graph.doorways[0].position.x(), 2.93, 1e-3);
  const std::vector<DoorLeaf>& leaves = graph.doorways[0].leaves;
  ASSERT_EQ(leaves.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(leaves[i].operation, LeafOperation::kSwing);
    EXPECT_EQ(leaves[i].jamb, i == 0 ? Jamb::kLeft : Jamb::kRight);
    EXPECT_EQ(leaves[i].opens_to, DoorwaySide::kRoomA);  // the other side is outside
    EXPECT_NEAR(leaves[i].width_m, 0.9, 1e-9);
  }
}

// A wall that is drawn as one line ends where its line does: a gap of 0.9 m is a doorway of 0.9 m.
TEST(AppendStorey, SingleLinesEndWhereTheyAreDrawn) {
  const Drawing drawing = WallLines({{0, 0, 8, 0}, {8, 0, 8, 5}, {8, 5, 0, 5}, {0, 5, 0, 0}, {4, 0, 4, 2}, {4, 2.9, 4, 5}});
  PlanIr plan;
  DiagnosticSink sink;
  ASSERT_TRUE(AppendStorey(drawing, {{}, "Ground", {}, 0.0}, {}, plan, sink));
  const AGraph graph = Compiled(plan);
  EXPECT_EQ(graph.rooms.size(), 2u);
  ASSERT_EQ(graph.doorways.size(), 1u);
  EXPECT_NEAR(graph.doorways[0].width_m, 0.9, 1e-3);
}

}  // namespace
}  // namespace plumb::compiler
