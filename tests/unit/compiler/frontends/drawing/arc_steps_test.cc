#include "compiler/frontends/drawing/arc_steps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

Vector2d On(const Arc& arc, double share) {
  const double a = arc.start_rad + share * arc.sweep_rad;
  return arc.center + arc.radius_m * Vector2d(std::cos(a), std::sin(a));
}

Drawing Along(const Arc& arc, int steps, bool closed) {
  Drawing out;
  out.paths.emplace_back();
  for (int i = 0; i <= steps; ++i) out.paths[0].points.push_back(On(arc, static_cast<double>(i) / steps));
  out.paths[0].arcs.push_back(arc);
  out.paths[0].closed = closed;
  return out;
}

TEST(RefineArcSteps, StepsOfALargeRadiusKeepCloseToTheirArc) {
  const Arc arc{{3, -100}, 100, 1.4, 0.2};
  Drawing drawing = Along(arc, 3, false);
  RefineArcSteps(0.001, drawing);
  const std::vector<Vector2d>& points = drawing.paths[0].points;
  EXPECT_EQ(points.size(), 25u);  // 24 steps of 0.83 m
  for (size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR((points[i] - arc.center).norm(), 100, 1e-9);
    const Vector2d& before = points[i > 0 ? i - 1 : 0];
    EXPECT_LE(100 - (0.5 * (before + points[i]) - arc.center).norm(), 0.001);
  }
  EXPECT_LT((points.back() - On(arc, 1)).norm(), 1e-9);
}

TEST(RefineArcSteps, ASmallRadiusStaysAsItIs) {
  Drawing drawing = Along({{0, 0}, 1, 0, 0.5 * std::numbers::pi}, 23, false);
  RefineArcSteps(0.001, drawing);
  EXPECT_EQ(drawing.paths[0].points.size(), 24u);
}

TEST(RefineArcSteps, TheChordOfAnArcIsNoStepOfIt) {
  for (const double sweep_rad : {0.1, 1.0}) {
    Drawing drawing = Along({{0, 0}, 50, 0, sweep_rad}, sweep_rad < 0.5 ? 2 : 15, true);
    RefineArcSteps(0.001, drawing);
    const std::vector<Vector2d>& points = drawing.paths[0].points;
    EXPECT_NEAR((points.back() - points.front()).norm(), 2 * 50 * std::sin(0.5 * sweep_rad), 1e-9) << sweep_rad;
    EXPECT_GT(points.size(), 5u);
  }
}

TEST(RefineArcSteps, AClosedCircleIsRefinedAllTheWayRound) {
  const double radius_m = 20;
  Drawing drawing = Along({{0, 0}, radius_m, 0, 2 * std::numbers::pi}, 90, true);
  drawing.paths[0].points.pop_back();
  RefineArcSteps(0.001, drawing);
  const std::vector<Vector2d>& points = drawing.paths[0].points;
  for (size_t i = 0; i < points.size(); ++i) EXPECT_GE((0.5 * (points[i] + points[(i + 1) % points.size()])).norm(), radius_m - 0.001);
}

}  // namespace
}  // namespace plumb::compiler
