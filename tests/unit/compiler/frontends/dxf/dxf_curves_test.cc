#include "compiler/frontends/dxf/dxf_curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumb::compiler {
namespace {

TEST(DxfCurves, BulgeOfOneIsAHalfCircleToTheRight) {
  const Arc arc = ArcOfBulge({0, 0}, {2, 0}, 1);
  EXPECT_NEAR((arc.center - Eigen::Vector2d(1, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(arc.radius_m, 1, 1e-12);
  EXPECT_NEAR(arc.sweep_rad, std::numbers::pi, 1e-12);
  std::vector<Eigen::Vector2d> points;
  AppendArc(arc, 0.002, points);
  EXPECT_NEAR((points.back() - Eigen::Vector2d(2, 0)).norm(), 0, 1e-12);
  EXPECT_LT(points[points.size() / 2].y(), -0.9);
}

TEST(DxfCurves, StepsStayWithinTheChord) {
  std::vector<Eigen::Vector2d> points;
  AppendArc({{0, 0}, 5, 0.3, 2.0}, 0.002, points);
  for (size_t i = 0; i + 1 < points.size(); ++i) EXPECT_GE((0.5 * (points[i] + points[i + 1])).norm(), 5 * (1 - 0.002) - 1e-9);
}

TEST(DxfCurves, QuadraticSplineOfABezierArcPassesItsMiddle) {
  SplineCurve spline;
  spline.degree = 2;
  spline.knots = {0, 0, 0, 1, 1, 1};
  spline.control = {{0, 0}, {1, 2}, {2, 0}};
  const auto points = SplinePoints(spline);
  ASSERT_FALSE(points.empty());
  EXPECT_NEAR((points.front() - Eigen::Vector2d(0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((points.back() - Eigen::Vector2d(2, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((points[points.size() / 2] - Eigen::Vector2d(1, 1)).norm(), 0, 1e-12);
}

TEST(DxfCurves, SplineWithWrongKnotsIsEmpty) {
  SplineCurve spline;
  spline.control = {{0, 0}, {1, 2}, {2, 0}};
  spline.knots = {0, 1};
  EXPECT_TRUE(SplinePoints(spline).empty());
  spline.control.clear();
  spline.fit = {{0, 0}, {1, 1}};
  EXPECT_EQ(SplinePoints(spline).size(), 2u);
}

}  // namespace
}  // namespace plumb::compiler
