#include "compiler/frontends/drawing/arc_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

std::vector<Vector2d> Quarter(double radius_m, int steps) {
  std::vector<Vector2d> out;
  for (int i = 0; i <= steps; ++i) {
    const double a = 0.5 * std::numbers::pi * i / steps;
    out.push_back(radius_m * Vector2d(std::cos(a), std::sin(a)));
  }
  return out;
}

Drawing Of(DrawnPath path) {
  Drawing out;
  out.paths.push_back(std::move(path));
  return out;
}

TEST(FitArcs, FacetsWithinACentimetreOfACircleAreAnArc) {
  DrawnPath path;
  path.role = LineRole::kWall;
  path.points = Quarter(5, 9);
  for (size_t i = 0; i < path.points.size(); ++i) path.points[i] *= 1 + (i % 2 == 0 ? 0.001 : -0.001);
  path.points.insert(path.points.begin(), Vector2d(5, -8));
  path.points.emplace_back(-8, 5);
  Drawing drawing = Of(path);
  FitArcs(drawing);
  ASSERT_EQ(drawing.paths[0].arcs.size(), 1u);
  EXPECT_NEAR(drawing.paths[0].arcs[0].radius_m, 5, 0.02);
  EXPECT_LT(drawing.paths[0].arcs[0].center.norm(), 0.02);
  EXPECT_NEAR(drawing.paths[0].arcs[0].sweep_rad, 0.5 * std::numbers::pi, 0.01);
}

TEST(FitArcs, StepsThatStandOffTheirCircleAreNone) {
  DrawnPath path;
  path.role = LineRole::kWall;
  path.points = Quarter(5, 9);
  for (Vector2d& p : path.points) p.y() *= 1.1;  // an ellipse
  Drawing drawing = Of(path);
  FitArcs(drawing);
  EXPECT_TRUE(drawing.paths[0].arcs.empty());
}

TEST(FitArcs, ClosedOutlinesHaveTheirArcsWhereverTheyBegin) {
  DrawnPath path;
  path.role = LineRole::kWall;
  path.closed = true;
  path.points = Quarter(5, 12);
  path.points.emplace_back(0, 0);
  for (size_t first = 0; first < path.points.size(); ++first) {
    DrawnPath turned = path;
    std::rotate(turned.points.begin(), turned.points.begin() + static_cast<std::ptrdiff_t>(first), turned.points.end());
    Drawing drawing = Of(turned);
    FitArcs(drawing);
    ASSERT_EQ(drawing.paths[0].arcs.size(), 1u) << first;
    EXPECT_NEAR(std::abs(drawing.paths[0].arcs[0].sweep_rad), 0.5 * std::numbers::pi, 1e-6) << first;
  }
}

TEST(FitArcs, LeavesDoorsAsTheSourceDrawsThem) {
  DrawnPath path;
  path.role = LineRole::kDoor;
  path.points = Quarter(0.9, 9);
  Drawing drawing = Of(path);
  FitArcs(drawing);
  EXPECT_TRUE(drawing.paths[0].arcs.empty());
}

TEST(SplitAtArcs, PartsAnOpenLineAtItsArcs) {
  DrawnPath path;
  path.points = Quarter(1, 8);
  path.points.insert(path.points.begin(), Vector2d(1, -3));
  const std::vector<DrawnPath> parts = SplitAtArcs(path);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_TRUE(parts[0].arcs.empty());
  ASSERT_EQ(parts[1].arcs.size(), 1u);
  EXPECT_TRUE(parts[1].curved);
}

}  // namespace
}  // namespace plumb::compiler
