#include "compiler/passes/weld.h"

#include <gtest/gtest.h>

namespace plumb::compiler {
namespace {

TEST(Weld, PointsWithinTheRadiusBecomeTheirMean) {
  const Welded w = Weld({{0, 0}, {5, 5}, {0.001, 0}, {0.003, 0}}, 0.002);
  EXPECT_EQ(w.points.size(), 3u);
  EXPECT_EQ(w.index[0], w.index[2]);
  EXPECT_NE(w.index[0], w.index[3]);
  EXPECT_NEAR(w.points[w.index[0]].x(), 0.0005, 1e-12);
}

TEST(Weld, TheOrderOfTheInputDoesNotMatter) {
  const std::vector<Eigen::Vector2d> forward = {{-1, 2}, {-1.0005, 2}, {3, 4}}, backward = {{3, 4}, {-1.0005, 2}, {-1, 2}};
  const Welded a = Weld(forward, 0.002), b = Weld(backward, 0.002);
  ASSERT_EQ(a.points.size(), 2u);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.index[0], b.index[2]);
}

TEST(Weld, IdenticalPointsKeepTheirBits) {
  const Eigen::Vector2d p(0.1, 1.0 / 3);
  EXPECT_EQ(Weld({p, p, p}, 0.002).points[0], p);
}

}  // namespace
}  // namespace plumb::compiler
