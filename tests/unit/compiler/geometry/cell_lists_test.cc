#include "compiler/geometry/cell_lists.h"

#include <gtest/gtest.h>

#include <random>

namespace plumb::compiler {
namespace {

TEST(CellLists, FindAllPointsInReach) {
  constexpr double kNear_m = 0.01;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-0.5, 0.5);
  std::vector<Eigen::Vector2d> points;
  CellLists lists(kNear_m);
  size_t visited = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector2d p(place(random), place(random));
    std::vector<bool> seen(points.size(), false);
    lists.ForEachNear(p, [&](uint32_t k) {
      ASSERT_LT(k, points.size());
      EXPECT_FALSE(seen[k]) << "visited twice";
      seen[k] = true;
      ++visited;
    });
    for (size_t k = 0; k < points.size(); ++k) EXPECT_TRUE(seen[k] || (points[k] - p).norm() > kNear_m);
    points.push_back(p);
    lists.Add(p);
  }
  EXPECT_LT(visited, 3000u * 3000u / 2 / 20) << "looks at most points each time";
}

TEST(CellLists, TakePlacesBeyondWhatCellsCount) {
  CellLists lists(0.002);
  lists.Add({1e300, -1e300});
  size_t found = 0;
  lists.ForEachNear({1e300, -1e300}, [&](uint32_t) { ++found; });
  EXPECT_EQ(found, 1u);
}

}  // namespace
}  // namespace plumb::compiler
