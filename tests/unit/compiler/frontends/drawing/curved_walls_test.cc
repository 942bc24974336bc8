// Curved walls from lines to the A-Graph: round rooms with doors and windows.
#include "compiler/frontends/drawing/curved_walls.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "compiler/frontends/drawing/arc_fit.h"
#include "compiler/frontends/drawing/plan_from_drawing.h"
#include "compiler/frontends/drawing/strokes.h"
#include "compiler/passes/build_agraph.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr double kPi = std::numbers::pi;
constexpr double kInner_m = 3.0, kOuter_m = 3.3, kMiddle_m = 3.15;

Vector2d Polar(double radius_m, double angle_rad) { return radius_m * Vector2d(std::cos(angle_rad), std::sin(angle_rad)); }

constexpr double kStep_rad = 0.0524;  // three degrees

void AppendArc(double radius_m, double from_rad, double to_rad, std::vector<Vector2d>& out, double step_rad = kStep_rad) {
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(to_rad - from_rad) / step_rad)));
  for (int i = 0; i <= steps; ++i) out.push_back(Polar(radius_m, from_rad + (to_rad - from_rad) * i / steps));
}

// A closed outline of a piece of ring wall.
DrawnPath Piece(double from_rad, double to_rad, LineRole role = LineRole::kWall) {
  DrawnPath out;
  out.role = role;
  out.closed = true;
  AppendArc(kInner_m, to_rad, from_rad, out.points);
  AppendArc(kOuter_m, from_rad, to_rad, out.points);
  return out;
}

DrawnPath Circle(double radius_m, double step_rad = kStep_rad) {
  DrawnPath out;
  out.role = LineRole::kWall;
  out.closed = true;
  AppendArc(radius_m, 0, 2 * kPi, out.points, step_rad);
  out.points.pop_back();
  return out;
}

AGraph GraphOf(Drawing drawing) {
  for (size_t i = 0; i < drawing.paths.size(); ++i) drawing.paths[i].location.guid = std::to_string(i);
  FitArcs(drawing);
  PlanIr plan;
  DiagnosticSink sink;
  EXPECT_TRUE(AppendStorey(drawing, {{}, "Ground", {}, 0.0}, {}, plan, sink));
  std::optional<Built> built = BuildAGraph(plan, {}, sink);
  EXPECT_TRUE(built.has_value());
  return built ? std::move(built->graph) : AGraph();
}

void ExpectRoundRoom(const AGraph& graph) {
  ASSERT_EQ(graph.rooms.size(), 1u);
  EXPECT_NEAR(graph.rooms[0].area_m2, kPi * kInner_m * kInner_m, 0.05);
  double inner_m = 0;
  for (const Surface& s : graph.surfaces) {
    if (!s.room.valid()) continue;
    ASSERT_TRUE(s.arc.has_value());
    EXPECT_NEAR(s.arc->radius_m, kInner_m, 0.002);
    inner_m += std::abs(s.arc->sweep_rad) * s.arc->radius_m;
  }
  EXPECT_GT(inner_m, 2 * kPi * kInner_m - 1.5);
}

void ExpectDoorAt(double at_rad, double width_m, const AGraph& graph) {
  ASSERT_EQ(graph.doorways.size(), 1u);
  EXPECT_LT((graph.doorways[0].position.head<2>() - Polar(kMiddle_m, at_rad)).norm(), 0.01);
  EXPECT_NEAR(graph.doorways[0].width_m, width_m, 0.01);
  EXPECT_TRUE(graph.doorways[0].room_a.valid());
  EXPECT_FALSE(graph.doorways[0].room_b.valid());  // outside
}

TEST(CurvedWalls, GapWithRadialJambsIsOneDoorway) {
  const double half_rad = std::asin(0.5 / kMiddle_m);
  Drawing drawing;
  drawing.paths.push_back(Piece(1 + half_rad, 1 - half_rad + 2 * kPi));
  const AGraph graph = GraphOf(drawing);
  ExpectRoundRoom(graph);
  ExpectDoorAt(1, 1.0, graph);
}

// What the drawn facets leave of the wall beside its own steps is a ring some millimetres thin, and no wall.
TEST(CurvedWalls, TwoCirclesOfAnyRadiusAndStepAreOneRoom) {
  for (const double radius_m : {2.0, 3.0, 3.7, 3.8, 4.1, 4.7, 5.0, 5.8, 7.0, 9.0}) {
    for (const double step_rad : {0.02, 0.0349, kStep_rad, 0.0873}) {
      for (const double thickness_m : {0.2, 0.3}) {
        SCOPED_TRACE(testing::Message() << "radius " << radius_m << " m, step " << step_rad << " rad, " << thickness_m << " m thick");
        Drawing drawing;
        drawing.paths = {Circle(radius_m, step_rad), Circle(radius_m + thickness_m, step_rad)};
        const AGraph graph = GraphOf(drawing);
        ASSERT_EQ(graph.rooms.size(), 1u);
        EXPECT_NEAR(graph.rooms[0].area_m2, kPi * radius_m * radius_m, 0.01 * radius_m * radius_m);
        for (const Surface& s : graph.surfaces) {
          ASSERT_TRUE(s.arc.has_value());
          EXPECT_NEAR(s.arc->radius_m, s.room.valid() ? radius_m : radius_m + thickness_m, 0.005);
        }
      }
    }
  }
}

TEST(CurvedWalls, LeafAndSwingOverAWallAllTheWayRoundAreOneDoorway) {
  Drawing drawing;
  drawing.paths = {Circle(kInner_m), Circle(kOuter_m)};
  const double half_rad = std::asin(0.45 / kOuter_m);
  const Vector2d hinge = Polar(kOuter_m, 2 - half_rad), jamb = Polar(kOuter_m, 2 + half_rad);
  DrawnPath swing;
  swing.role = LineRole::kDoor;
  const double from_rad = std::atan2((jamb - hinge).y(), (jamb - hinge).x());
  swing.arcs.push_back({hinge, 0.9, from_rad, -0.5 * kPi});
  for (int i = 0; i <= 9; ++i) swing.points.push_back(hinge + Polar(0.9, from_rad - 0.5 * kPi * i / 9));
  drawing.paths.push_back(swing);
  const AGraph graph = GraphOf(drawing);
  ExpectRoundRoom(graph);
  ExpectDoorAt(2, 0.9, graph);
}

TEST(CurvedWalls, WindowInAGapOrOverTheWallIsOneWindow) {
  const double half_rad = std::asin(0.75 / kMiddle_m);
  Drawing over;
  over.paths = {Circle(kInner_m), Circle(kOuter_m), Piece(-1 - half_rad, -1 + half_rad, LineRole::kWindow)};
  Drawing gap;
  gap.paths = {Piece(-1 + half_rad, -1 - half_rad + 2 * kPi), Piece(-1 - half_rad, -1 + half_rad, LineRole::kWindow)};
  for (const Drawing& drawing : {over, gap}) {
    const AGraph graph = GraphOf(drawing);
    ExpectRoundRoom(graph);
    EXPECT_TRUE(graph.doorways.empty());
    ASSERT_EQ(graph.windows.size(), 1u);
    EXPECT_LT((graph.windows[0].position.head<2>() - Polar(kMiddle_m, -1)).norm(), 0.01);
    EXPECT_NEAR(graph.windows[0].width_m, 1.5, 0.01);
  }
}

// A shell of straight and curved sides, drawn as one outline around the building and one around the room.
TEST(CurvedWalls, ArcsAmongTheSidesOfAShellAreArcs) {
  Drawing drawing;
  for (const double r_m : {kInner_m, kOuter_m}) {
    DrawnPath shell;
    shell.role = LineRole::kWall;
    shell.closed = true;
    AppendArc(r_m, -0.5 * kPi, 0.5 * kPi, shell.points);
    shell.points.emplace_back(-4 - (r_m - kInner_m), r_m);
    shell.points.emplace_back(-4 - (r_m - kInner_m), -r_m);
    drawing.paths.push_back(shell);
  }
  const AGraph graph = GraphOf(drawing);
  ASSERT_EQ(graph.rooms.size(), 1u);
  EXPECT_NEAR(graph.rooms[0].area_m2, 4 * 2 * kInner_m + 0.5 * kPi * kInner_m * kInner_m, 0.05);
  size_t straight = 0, arcs = 0;
  for (const Surface& s : graph.surfaces) {
    if (!s.room.valid()) continue;
    ++(s.arc ? arcs : straight);
    EXPECT_NEAR(s.arc ? std::abs(s.arc->sweep_rad) : kPi, kPi, 0.02);
  }
  EXPECT_EQ(arcs, 1u);
  EXPECT_EQ(straight, 3u);
}

// Its outlines are on no layer that says so, and their corner has the radius of a door's swing.
TEST(CurvedWalls, ARoundedCornerIsNoSwing) {
  Drawing drawing;
  for (const double off_m : {0.0, 0.2}) {
    DrawnPath shell;
    shell.closed = true;
    for (int i = 0; i <= 10; ++i) shell.points.emplace_back(Vector2d(5, 3) + Polar(1 + off_m, 0.05 * kPi * i));
    shell.points.emplace_back(-off_m, 4 + off_m);
    shell.points.emplace_back(-off_m, -off_m);
    shell.points.emplace_back(6 + off_m, -off_m);
    drawing.paths.push_back(shell);
  }
  const AGraph graph = GraphOf(drawing);
  ASSERT_EQ(graph.rooms.size(), 1u);
  EXPECT_NEAR(graph.rooms[0].area_m2, 24 - (1 - 0.25 * kPi), 0.02);
  EXPECT_TRUE(graph.doorways.empty());
}

TEST(CurvedWalls, APartitionThatMeetsARoundWallLeavesItAnArc) {
  Drawing drawing;
  drawing.paths = {Circle(kInner_m), Circle(kOuter_m)};
  for (const double y_m : {0.95, 1.05}) {
    DrawnPath line;
    line.role = LineRole::kWall;
    const double x_m = std::sqrt(kInner_m * kInner_m - y_m * y_m);
    line.points = {{-x_m, y_m}, {x_m, y_m}};
    drawing.paths.push_back(line);
  }
  const AGraph graph = GraphOf(drawing);
  EXPECT_EQ(graph.rooms.size(), 2u);
  size_t outside = 0;
  for (const Surface& s : graph.surfaces) {
    if (s.room.valid() || !(s.start.norm() > kMiddle_m)) continue;
    ++outside;
    EXPECT_TRUE(s.arc.has_value());
  }
  EXPECT_GT(outside, 0u);
}

// The surfaces of the room are one arc of this radius each, but for `straight_m` of them.
void ExpectArcsOf(double radius_m, double straight_m, const AGraph& graph) {
  ASSERT_EQ(graph.rooms.size(), 1u);
  double flat_m = 0, curved_m = 0;
  for (const Surface& s : graph.surfaces) {
    if (!s.room.valid()) continue;
    if (!s.arc) {
      flat_m += (s.end - s.start).norm();
      continue;
    }
    EXPECT_NEAR(s.arc->radius_m, radius_m, 0.003);
    curved_m += std::abs(s.arc->sweep_rad) * s.arc->radius_m;
  }
  EXPECT_NEAR(flat_m, straight_m, 0.1);
  EXPECT_GT(curved_m, 0.9 * kPi * radius_m);
}

// Half a circle on the middle of the wall, and its chord.
Drawing Apse(double radius_m) {
  Drawing out;
  DrawnPath curve, chord;
  curve.role = chord.role = LineRole::kWall;
  AppendArc(radius_m, 0, kPi, curve.points);
  chord.points = {{-radius_m, 0}, {radius_m, 0}};
  out.paths = {curve, chord};
  return out;
}

TEST(CurvedWalls, ASingleLineAlongAnArcIsACurvedWall) {
  const double half_m = 0.5 * MassOptions().single_line_thickness_m;
  const AGraph graph = GraphOf(Apse(4));
  ExpectArcsOf(4 - half_m, 2 * (4 - half_m), graph);
  EXPECT_NEAR(graph.rooms[0].area_m2, 0.5 * kPi * 16 - half_m * (8 + 4 * kPi), 0.1);
}

TEST(CurvedWalls, ASingleLineAroundACircleIsARoundRoom) {
  Drawing drawing;
  drawing.paths = {Circle(4)};
  ExpectArcsOf(4 - 0.5 * MassOptions().single_line_thickness_m, 0, GraphOf(drawing));
}

TEST(CurvedWalls, AThickStrokeAlongAnArcIsACurvedWall) {
  Drawing drawing = Apse(4);
  for (DrawnPath& path : drawing.paths) path.stroke_m = 0.3;
  WidenStrokes(drawing);
  const AGraph graph = GraphOf(drawing);
  ExpectArcsOf(3.85, 2 * 3.85, graph);
  EXPECT_NEAR(graph.rooms[0].area_m2, 0.5 * kPi * 16 - 0.15 * (8 + 4 * kPi), 0.15);
}

TEST(CurvedWalls, AThickStrokeAroundACircleIsARoundRoom) {
  Drawing drawing;
  drawing.paths = {Circle(4)};
  drawing.paths[0].stroke_m = 0.3;
  WidenStrokes(drawing);
  ExpectArcsOf(3.85, 0, GraphOf(drawing));
}

}  // namespace
}  // namespace plumb::compiler
