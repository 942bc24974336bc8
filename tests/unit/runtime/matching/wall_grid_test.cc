#include "runtime/matching/wall_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace plumb::runtime {
namespace {

constexpr double kReach_m = 0.15;

double Distance_m(const MapWall& wall, const Eigen::Vector2d& at) {
  const double u_m = std::clamp(wall.along.dot(at - wall.start), 0.0, wall.length_m);
  return (wall.start + u_m * wall.along - at).norm();
}

TEST(WallGrid, TellsAllWallsWithinReachAndFewOthers) {
  std::mt19937 rng(1);
  const auto within = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(rng() >> 8) / static_cast<double>(1u << 24);
  };
  std::vector<MapWall> walls(300);
  for (MapWall& wall : walls) {
    const double heading_rad = within(0, 2 * std::numbers::pi);
    wall.start = {within(-20, 20), within(-20, 20)};
    wall.along = {std::cos(heading_rad), std::sin(heading_rad)};
    wall.length_m = within(0.4, 8);
    wall.end = wall.start + wall.length_m * wall.along;
  }
  const WallGrid grid(walls, kReach_m);
  size_t told = 0, within_reach = 0;
  constexpr size_t kPoints = 20000;
  for (size_t i = 0; i < kPoints; ++i) {
    const Eigen::Vector2d at(within(-25, 25), within(-25, 25));
    const std::span<const uint32_t> near = grid.Near(at);
    EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
    EXPECT_EQ(std::adjacent_find(near.begin(), near.end()), near.end()) << "told twice";
    told += near.size();
    for (uint32_t k = 0; k < walls.size(); ++k) {
      if (Distance_m(walls[k], at) > kReach_m) continue;
      ++within_reach;
      EXPECT_TRUE(std::binary_search(near.begin(), near.end(), k)) << "wall " << k << " at " << at.transpose();
    }
  }
  EXPECT_GT(within_reach, 1000u);
  EXPECT_LT(told, kPoints * walls.size() / 50);
}

TEST(WallGrid, HasNoneWhereNoneStand) { EXPECT_TRUE(WallGrid({}, kReach_m).Near({0, 0}).empty()); }

}  // namespace
}  // namespace plumb::runtime
