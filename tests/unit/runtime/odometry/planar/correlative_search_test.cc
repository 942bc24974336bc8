#include "runtime/odometry/planar/correlative_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/odometry/planar/submap.h"
#include "tests/support/planar_world.h"

namespace plumb::runtime {
namespace {

PlanarScan ScanAt(const test::PlanarWorld& world, const Pose2& pose, uint64_t seed) {
  return MakePlanarScan(PrepareScan(world.Sweep(pose, 0, seed), 0.04, 0.4, 30), Eigen::Matrix3d::Identity(), {}, 0.02);
}

LikelihoodGrid RoomGrid(const test::PlanarWorld& world) {
  const PlanarScan scan = ScanAt(world, {{-2, 0}, 0}, 1), back = ScanAt(world, {{2, 0}, 3.0}, 2);
  const std::vector<PlacedScan> placed = {{&scan, {{-2, 0}, 0}}, {&back, {{2, 0}, 3.0}}};
  return GridOf(placed, {0, 0});
}

TEST(CorrelativeSearch, FindsAPoseFarFromThePrior) {
  const test::PlanarWorld world = test::MakeLoopWorld();
  const LikelihoodGrid grid = RoomGrid(world);
  const Pose2 truth{{-1.1, 0.35}, 0.52};
  const PlanarPrior prior{{{-1.9, -0.3}, 0.0}, 0.4, 0.3};
  const SearchResult found = grid.Search(SearchPoints(ScanAt(world, truth, 3)), prior, {1.5, 0.9});
  EXPECT_GT(found.share, 0.75);
  EXPECT_LT((found.pose.t_m - truth.t_m).norm(), 0.05);
  EXPECT_NEAR(found.pose.yaw_rad, truth.yaw_rad, 0.02);
}

// Branch and bound returns what trying everything does.
TEST(CorrelativeSearch, IsExactWithinItsGrid) {
  const test::PlanarWorld world = test::MakeLoopWorld();
  const LikelihoodGrid grid = RoomGrid(world);
  const std::vector<Eigen::Vector2d> points = SearchPoints(ScanAt(world, {{-1.4, 0.1}, 0.1}, 5));
  const PlanarPrior prior{{{-1.6, 0.2}, 0.05}, 0.2, 0.1};
  const SearchResult found = grid.Search(points, prior, {0.3, 0.1});
  double far_m = 1.0;
  for (const Eigen::Vector2d& p : points) far_m = std::max(far_m, std::min(p.norm(), 12.0));
  double best = -1e9;
  for (int k = -40; k <= 40; ++k) {
    const double turn_rad = k * 0.05 / far_m;
    if (std::abs(k) > std::ceil(0.1 * far_m / 0.05)) continue;
    for (int y = -6; y <= 6; ++y) {
      for (int x = -6; x <= 6; ++x) {
        // A search of one cell: no branch, no bound.
        const Pose2 at{prior.mean.t_m + 0.05 * Eigen::Vector2d(x, y), prior.mean.yaw_rad + turn_rad};
        const SearchResult one = grid.Search(points, {at, 1e3, 1e3}, {0, 0});
        best = std::max(best, one.log_score + prior.LogDensity(0.0025 * (x * x + y * y), turn_rad));
      }
    }
  }
  EXPECT_NEAR(found.log_score, best, 0.15);  // cells of moved priors round differently by a point or two
  EXPECT_GE(found.log_score, best - 0.15);
}

TEST(CorrelativeSearch, PriorDecidesAlongACorridorWithoutEnd) {
  test::PlanarWorld world;
  world.AddWall({-100, -1}, {100, -1});
  world.AddWall({-100, 1}, {100, 1});
  const PlanarScan scan = ScanAt(world, {}, 1);
  const std::vector<PlacedScan> placed = {{&scan, {}}};
  const LikelihoodGrid grid = GridOf(placed, {0, 0});
  const SearchResult found = grid.Search(SearchPoints(ScanAt(world, {{0.5, 0.1}, 0}, 2)), {{{0.3, 0}, 0}, 0.1, 0.05}, {0.5, 0.2});
  EXPECT_NEAR(found.pose.t_m.x(), 0.3, 0.15);
  EXPECT_NEAR(found.pose.t_m.y(), 0.1, 0.04);
}

TEST(CorrelativeSearch, NothingToSearchForLeavesThePrior) {
  const LikelihoodGrid grid({}, {0, 0}, 10);
  EXPECT_EQ(grid.Search({}, {{{1, 2}, 0.5}, 0.1, 0.1}, {1, 1}).pose.t_m, Eigen::Vector2d(1, 2));
  const std::vector<Eigen::Vector2d> one = {{3, 4}};
  const SearchResult found = grid.Search(one, {{{1, 2}, 0.5}, 0.1, 0.1}, {0.5, 0.1});
  EXPECT_EQ(found.share, 0);
  EXPECT_LT((found.pose.t_m - Eigen::Vector2d(1, 2)).norm(), 1e-9);
}

}  // namespace
}  // namespace plumb::runtime
