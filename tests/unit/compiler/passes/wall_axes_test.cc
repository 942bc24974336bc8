#include "compiler/passes/wall_axes.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/plan_builder.h"
#include "tests/unit/compiler/passes/build.h"

namespace plumb::compiler {
namespace {

using test::Rectangle;

TEST(AxisOfFootprint, OfARectangleIsItsCentreLine) {
  const WallAxis axis = AxisOfFootprint({Rectangle({1, 2}, {5, 2.3})}, {0, 0});
  EXPECT_NEAR(axis.thickness_m, 0.3, 1e-12);
  EXPECT_NEAR(axis.start.y(), 2.15, 1e-12);
  EXPECT_NEAR((axis.end - axis.start).norm(), 4, 1e-12);
}

TEST(AxisOfFootprint, OfAShortThickWallFollowsTheStatedDirection) {
  const WallAxis axis = AxisOfFootprint({Rectangle({0, 0}, {0.2, 0.5})}, {1, 0});
  EXPECT_NEAR(axis.thickness_m, 0.5, 1e-12);
  EXPECT_NEAR(std::abs((axis.end - axis.start).x()), 0.2, 1e-12);
}

TEST(AxisOfFootprint, OfAnLFollowsItsLongerArm) {
  const WallAxis axis = AxisOfFootprint({{{0, 0}, {5, 0}, {5, 0.2}, {0.2, 0.2}, {0.2, 3}, {0, 3}}}, {0, 0});
  EXPECT_NEAR(axis.thickness_m, 0.2, 1e-12);
  EXPECT_NEAR(axis.start.y(), 0.1, 1e-12);
  EXPECT_NEAR((axis.end - axis.start).norm(), 5, 1e-12);
}

TEST(AxisOfFootprint, OfAWallAroundACourtIsNotThatOfTheCourt) {
  Ring hole = Rectangle({0.3, 0.3}, {9.7, 7.7});
  std::reverse(hole.begin(), hole.end());
  EXPECT_NEAR(AxisOfFootprint({Rectangle({0, 0}, {10, 8}), hole}, {0, 0}).thickness_m, 0.3, 1e-12);
}

TEST(AxisOfFootprint, OfFacetsHasTheThicknessOfTheStrip) {
  Ring ring;
  for (int i = 0; i <= 40; ++i) ring.emplace_back(5.2 * std::cos(i * 0.05), 5.2 * std::sin(i * 0.05));
  for (int i = 40; i >= 0; --i) ring.emplace_back(5.0 * std::cos(i * 0.05), 5.0 * std::sin(i * 0.05));
  EXPECT_NEAR(AxisOfFootprint({ring}, {0, 0}).thickness_m, 0.2, 2e-3);
}

TEST(AddWalls, TakesStatedThicknessAndDirectionButNotAnAxisOnTheFace) {
  test::PlanBuilder b;
  b.Storey("0", 0);
  const uint32_t w = b.Wall("w", {0, 0}, {4, 0}, 0.3);
  b.plan.elements[w].axis = {{4, 0.15}, {0, 0.15}};  // along one face, the other way round
  b.plan.elements[w].thickness_m = 0.3002;
  const AGraph graph = Build(b.plan).graph;
  ASSERT_EQ(graph.walls.size(), 1u);
  EXPECT_DOUBLE_EQ(graph.walls[0].thickness_m, 0.3002);
  EXPECT_NEAR(graph.walls[0].axis_start.x(), 4, 1e-9);
  EXPECT_NEAR(graph.walls[0].axis_start.y(), 0, 1e-9);
  b.plan.elements[w].thickness_m = 0.5;  // not what is drawn
  EXPECT_NEAR(Build(b.plan).graph.walls[0].thickness_m, 0.3, 1e-9);
}

}  // namespace
}  // namespace plumb::compiler
