#include "compiler/passes/polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/plan_builder.h"

namespace plumb::compiler {
namespace {

using test::Rectangle;

Ring Reversed(Ring ring) {
  std::reverse(ring.begin(), ring.end());
  return ring;
}

TEST(Polygon, AreaAndCentroidWithHole) {
  const std::vector<Ring> rings = {Rectangle({0, 0}, {4, 2}), Reversed(Rectangle({0, 0}, {2, 2}))};
  EXPECT_DOUBLE_EQ(RegionArea(rings), 4);
  EXPECT_TRUE(Centroid(rings).isApprox(Eigen::Vector2d(3, 1)));
  EXPECT_EQ(WindingNumber(rings, {1, 1}), 0);
  EXPECT_EQ(WindingNumber(rings, {3, 1}), 1);
}

TEST(Polygon, OverlapOfCrossingRectanglesIsTheirCommonSquare) {
  const std::vector<Ring> a = {Rectangle({0, 1}, {3, 2})}, b = {Rectangle({1, 0}, {2, 3})};
  EXPECT_NEAR(OverlapArea(a, b), 1, 1e-12);
  EXPECT_NEAR(OverlapArea(a, a), 3, 1e-12);
}

TEST(Polygon, OverlapOfTiltedSquares) {
  // |x| + |y| <= 1 and [0, 1]^2: a triangle of area 1/2.
  const std::vector<Ring> diamond = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}}, square = {Rectangle({0, 0}, {1, 1})};
  EXPECT_NEAR(OverlapArea(diamond, square), 0.5, 1e-12);
  // Two parts that overlap each other count once.
  const std::vector<Ring> two = {Rectangle({0, 0}, {2, 1}), Rectangle({1, 0}, {3, 1})};
  EXPECT_NEAR(RegionArea(two), 3, 1e-12);
}

TEST(Polygon, SimplifiedDropsCollinearPointsAndSpikes) {
  const Ring ring = {{0, 0}, {1, 0.0001}, {2, 0}, {2, 1}, {2, 3}, {2, 1}, {0, 1}};
  EXPECT_EQ(Simplified(ring, 0.001).size(), 4u);
  EXPECT_NEAR(SignedArea(Simplified(ring, 0.001)), 2, 1e-3);
  EXPECT_TRUE(Simplified({{0, 0}, {1, 0}, {2, 0}}, 0.001).empty());
}

TEST(Polygon, LeastRectangleOfARotatedOne) {
  const Eigen::Rotation2Dd turn(0.4);
  std::vector<Eigen::Vector2d> points;
  for (const auto& p : Rectangle({0, 0}, {3, 1})) points.push_back(turn * p);
  points.push_back(turn * Eigen::Vector2d(1, 0.5));
  EXPECT_NEAR(SignedArea(LeastRectangle(points)), 3, 1e-9);
}

TEST(OverlapArea, HostilePolygonsTakeBoundedTime) {
  // A star of 601 corners, each joined to those almost opposite: some 180,000 crossings. Beyond a third of the radius the share of a
  // circle that lies within its points is (1 / r - 1) / 2.
  Ring star;
  for (int i = 0; i < 601; ++i) {
    const double a = 2 * std::numbers::pi * i * 300 / 601;
    star.emplace_back(std::cos(a), std::sin(a));
  }
  EXPECT_NEAR(RegionArea(std::vector<Ring>{star}), std::numbers::pi / 3, 1e-3);
}

TEST(CommonCorners, AreThoseOfTheIntersection) {
  const std::vector<Ring> a = {test::Rectangle({0, 0}, {4, 1})}, b = {test::Rectangle({1, -3}, {2, 3})},
                          c = {test::Rectangle({9, 9}, {10, 10})};
  Eigen::AlignedBox2d box;
  for (const auto& p : CommonCorners(a, b)) box.extend(p);
  EXPECT_TRUE(box.isApprox(Eigen::AlignedBox2d(Eigen::Vector2d(1, 0), Eigen::Vector2d(2, 1))));
  EXPECT_TRUE(CommonCorners(a, c).empty());
}

}  // namespace
}  // namespace plumb::compiler
