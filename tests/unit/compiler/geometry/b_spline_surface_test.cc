#include "compiler/geometry/b_spline_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

// A full turn of a cylinder of radius 2 and height 3 in quarters: along u the turn, along v the height.
BSplineSurface Cylinder() {
  const double w = std::numbers::sqrt2 / 2;
  BSpline turn{2, {}, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}}, up{1, {}, {0, 0, 1, 1}};
  up.points.resize(2);
  BSplineSurface out{{}, up};
  for (const double z : {0.0, 3.0}) {
    turn.points.clear();
    for (int k = 0; k <= 8; ++k) {
      const double a = k * std::numbers::pi / 4, weight = k % 2 == 0 ? 1 : w, r = 2 / weight;
      turn.points.push_back(weight * Vector4d(r * std::cos(a), r * std::sin(a), z, 1));
    }
    out.columns.push_back(turn);
  }
  return out;
}

// Long and with as many control points as asked for.
BSplineSurface Sheet(size_t columns, size_t rows, size_t degree) {
  const auto knots = [&](size_t points) {
    std::vector<double> out(degree + 1, 0);
    while (out.size() < points) out.push_back(out.back() + 1);
    out.insert(out.end(), degree + 1, out.back() + 1);
    return out;
  };
  BSplineSurface out;
  for (size_t j = 0; j < columns; ++j) {
    BSpline column{degree, {}, knots(rows)};
    for (size_t i = 0; i < rows; ++i) column.points.emplace_back(0.1 * static_cast<double>(i), 0.1 * static_cast<double>(j), 0, 1);
    out.columns.push_back(column);
  }
  out.across = {degree, std::vector<Vector4d>(columns), knots(columns)};
  return out;
}

TEST(BSplineSurface, PointsOfACylinder) {
  const BSplineSurface cylinder = Cylinder();
  for (const double u : {0.0, 0.3, 1.0, 2.7, 4.0}) {
    for (const double v : {0.0, 0.4, 1.0}) {
      const Vector3d p = cylinder.At(u, v);
      EXPECT_NEAR(p.head<2>().norm(), 2, 1e-12);
      EXPECT_NEAR(p.z(), 3 * v, 1e-12);
    }
  }
  EXPECT_TRUE(cylinder.is_ruled());
}

TEST(BSplineUnroller, FindsParametersAndPeriod) {
  const BSplineSurface cylinder = Cylinder();
  const BSplineUnroller unroller(cylinder);
  const double turn = unroller.Periods().x();
  EXPECT_NEAR(turn, 4 * std::numbers::pi, 0.1);
  EXPECT_EQ(unroller.Periods().y(), 0);
  for (const double u : {0.2, 1.7, 3.1}) EXPECT_LT((unroller.Flat(cylinder.At(u, 0.4)) - Vector2d(u / 4 * turn, 1.2)).norm(), 1e-6);
}

TEST(BSplineUnroller, KnowsItsPoles) {
  BSplineSurface cone = Cylinder();
  for (Vector4d& p : cone.columns[1].points) p.head<2>().setZero();
  const BSplineUnroller unroller(cone);
  EXPECT_TRUE(unroller.IsPole({0, 0, 3}));
  EXPECT_FALSE(unroller.IsPole({2, 0, 0}));
  EXPECT_FALSE(BSplineUnroller(Cylinder()).IsPole({2, 0, 0}));
}

// The nodes are fewer than the spans: from the nearest one the point is found all the same.
TEST(BSplineUnroller, FindsParametersOnALargeSheet) {
  const BSplineSurface sheet = Sheet(60, 300, 3);
  const BSplineUnroller unroller(sheet);
  const Vector2d a = unroller.Flat({5, 3, 0}), b = unroller.Flat({5.5, 3.25, 0});
  EXPECT_LT((b - a - Vector2d(0.5, 0.25)).norm(), 0.02);
}

TEST(BSplineUnroller, StepsDoNotGrowWithTheSheet) {
  EXPECT_LT(BSplineUnroller::StepsFor(Sheet(10, 10, 3), 40), 200000u);
  EXPECT_LT(BSplineUnroller::StepsFor(Sheet(300, 300, 1), 1000), 3000000u);
  EXPECT_GT(BSplineUnroller::StepsFor(Sheet(300, 300, 1), 1000), BSplineUnroller::StepsFor(Sheet(300, 300, 1), 10));
}

}  // namespace
}  // namespace plumb::compiler
