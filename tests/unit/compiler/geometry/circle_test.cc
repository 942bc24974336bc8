#include "compiler/geometry/circle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace plumb::compiler {
namespace {

TEST(FitCircle, IsExactForPointsOnACircleFarFromZero) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= 8; ++i) points.emplace_back(1e5 + 3 * std::cos(0.1 * i), -2e5 + 3 * std::sin(0.1 * i));
  const auto circle = FitCircle(points);
  ASSERT_TRUE(circle);
  EXPECT_NEAR((circle->center - Eigen::Vector2d(1e5, -2e5)).norm(), 0, 1e-6);
  EXPECT_NEAR(circle->radius_m, 3, 1e-6);
}

TEST(FitCircle, IsNoneForALineAndForTooFewPoints) {
  EXPECT_FALSE(FitCircle(std::vector<Eigen::Vector2d>{{0, 0}, {1, 1}, {2, 2}, {5, 5}}));
  EXPECT_FALSE(FitCircle(std::vector<Eigen::Vector2d>{{0, 0}, {1, 1}}));
  EXPECT_FALSE(FitCircle(std::vector<Eigen::Vector2d>{}));
}

}  // namespace
}  // namespace plumb::compiler
