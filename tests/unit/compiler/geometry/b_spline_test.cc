#include "compiler/geometry/b_spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumb::compiler {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

// A quarter of the unit circle, exact as a rational curve.
BSpline Quarter() {
  const double w = std::numbers::sqrt2 / 2;
  return {2, {Vector4d(1, 0, 0, 1), Vector4d(w, w, 0, w), Vector4d(0, 1, 0, 1)}, {0, 0, 0, 1, 1, 1}};
}

TEST(BSpline, RationalCurveIsACircle) {
  const BSpline quarter = Quarter();
  EXPECT_NEAR((quarter.At(0) - Vector3d(1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((quarter.At(1) - Vector3d(0, 1, 0)).norm(), 0, 1e-12);
  for (const double u : {0.1, 0.3, 0.5, 0.9}) EXPECT_NEAR(quarter.At(u).norm(), 1, 1e-12) << u;
}

TEST(BSpline, SamplesKeepWithinTheTolerance) {
  for (const double tolerance_m : {1e-2, 1e-3, 1e-4}) {
    const Ring3 points = Quarter().Sample(0, 1, tolerance_m, 1000);
    ASSERT_GE(points.size(), 9u);
    for (size_t i = 1; i < points.size(); ++i) EXPECT_GT(((points[i - 1] + points[i]) / 2).norm(), 1 - tolerance_m);
  }
  EXPECT_LT(Quarter().Sample(0, 1, 1e-2, 1000).size(), Quarter().Sample(0, 1, 1e-5, 1000).size());
}

TEST(BSpline, SamplesAPart) {
  const Ring3 points = Quarter().Sample(0.25, 0.5, 1e-3, 1000);
  EXPECT_EQ(points.front(), Quarter().At(0.25));
  EXPECT_EQ(points.back(), Quarter().At(0.5));
  EXPECT_TRUE(Quarter().Sample(2, 3, 1e-3, 1000).empty());
}

TEST(BSpline, StopsBeyondTheMostPoints) {
  BSpline line{1, {}, {0, 0}};
  for (int i = 0; i <= 100; ++i) line.points.emplace_back(i, 0, 0, 1);
  for (int i = 1; i < 100; ++i) line.knots.push_back(i);
  line.knots.insert(line.knots.end(), {100, 100});
  EXPECT_EQ(line.Sample(0, 100, 1e-3, 10000).size(), 801u);
  EXPECT_LT(line.Sample(0, 100, 1e-3, 20).size(), 40u);
}

TEST(ExpandKnots, RepeatsThemAndRefusesWhatDoesNotFit) {
  const std::vector<double> knots = {0, 1, 2}, counts = {3, 1, 3}, falling = {0, 2, 1}, too_many = {4, 1, 2};
  EXPECT_EQ(ExpandKnots(knots, counts, 2, 4), (std::vector<double>{0, 0, 0, 1, 2, 2, 2}));
  EXPECT_TRUE(ExpandKnots(knots, counts, 2, 5).empty());
  EXPECT_TRUE(ExpandKnots(falling, counts, 2, 4).empty());
  EXPECT_TRUE(ExpandKnots(knots, too_many, 2, 4).empty());
  EXPECT_TRUE(ExpandKnots({knots.data(), 2}, counts, 2, 4).empty());
}

}  // namespace
}  // namespace plumb::compiler
