#include "compiler/passes/opening_extent.h"

#include <gtest/gtest.h>

namespace plumb::compiler {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

// 4 m by 0.2 m, counter-clockwise.
const std::vector<Ring> kWall = {{{0, 0}, {4, 0}, {4, 0.2}, {0, 0.2}}};

TEST(WithinWall, KeepsAnOpeningInsideTheWall) {
  const AlignedBox2d opening(Vector2d(1, -0.1), Vector2d(2, 0.3));
  EXPECT_TRUE(WithinWall(opening, Vector2d::UnitX(), kWall).isApprox(opening));
}

TEST(WithinWall, CutsAnOpeningThatIsWiderThanTheWall) {
  const AlignedBox2d opening(Vector2d(-0.5, -0.1), Vector2d(5, 0.3));
  EXPECT_TRUE(WithinWall(opening, Vector2d::UnitX(), kWall).isApprox(AlignedBox2d(Vector2d(0, -0.1), Vector2d(4, 0.3))));
}

TEST(WithinWall, MeasuresAlongTheGivenDirection) {
  const AlignedBox2d opening(Vector2d(-9, -0.1), Vector2d(-2, 0.3));
  EXPECT_TRUE(WithinWall(opening, -Vector2d::UnitX(), kWall).isApprox(AlignedBox2d(Vector2d(-4, -0.1), Vector2d(-2, 0.3))));
}

TEST(WithinWall, LeavesAnOpeningBesideTheWall) {
  const AlignedBox2d opening(Vector2d(5, 0), Vector2d(6, 0.2));
  EXPECT_TRUE(WithinWall(opening, Vector2d::UnitX(), kWall).isApprox(opening));
  EXPECT_TRUE(WithinWall(opening, Vector2d::UnitX(), {}).isApprox(opening));
}

TEST(SolidInterval, IsThePieceOfWallNextToTheOpening) {
  std::vector<Ring> two = kWall;
  two.push_back({{0, 1}, {4, 1}, {4, 1.3}, {0, 1.3}});
  const auto near = SolidInterval(two, Vector2d(2, 0.1), Vector2d::UnitY());
  ASSERT_TRUE(near);
  EXPECT_NEAR(near->first, -0.1, 1e-12);
  EXPECT_NEAR(near->second, 0.1, 1e-12);
  const auto far = SolidInterval(two, Vector2d(2, 0.9), Vector2d::UnitY());
  ASSERT_TRUE(far);
  EXPECT_NEAR(far->first, 0.1, 1e-12);
  EXPECT_NEAR(far->second, 0.4, 1e-12);
  EXPECT_FALSE(SolidInterval(two, Vector2d(7, 0), Vector2d::UnitY()));
}

TEST(SolidInterval, GoesOnFromOnePartOfAWallToTheNext) {
  // Two facets that share an askew end, which the line across runs through.
  const std::vector<Ring> parts = {{{0, 0}, {2, 0}, {2.1, 0.3}, {0, 0.3}}, {{2, 0}, {4, 0}, {4, 0.3}, {2.1, 0.3}}};
  const auto found = SolidInterval(parts, Vector2d(2.05, 0.1), Vector2d::UnitY());
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->first, -0.1, 1e-12);
  EXPECT_NEAR(found->second, 0.2, 1e-12);
}

TEST(SideNextTo, IsTheDirectionOfTheNearestSide) {
  const std::vector<Ring> bent = {{{0, 0}, {2, 0}, {3, 1}, {3, 1.3}, {1.9, 0.2}, {0, 0.2}}};
  const auto side = SideNextTo(bent, Vector2d(2.6, 0.5));
  ASSERT_TRUE(side);
  EXPECT_TRUE(side->isApprox(Vector2d(1, 1).normalized()));
  EXPECT_FALSE(SideNextTo({}, Vector2d::Zero()));
}

}  // namespace
}  // namespace plumb::compiler
