#include "runtime/mapping/bridges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runtime/mapping/cell_planes.h"
#include "runtime/mapping/plane_fit.h"

namespace plumb::runtime {
namespace {

// A wall 2 m high from x = `from_m` to `to_m`, seen from smaller y, that stands at y = 0 at `foot_m` and leans from there by `turn_rad`.
Segment Wall(double from_m, double to_m, double foot_m, double turn_rad, int cell_points, double noise_m = 0.025) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, noise_m);
  Segment segment;
  for (double x_m = from_m + 0.05; x_m < to_m; x_m += kCell_m) {
    const double y_m = -std::tan(turn_rad) * (x_m - foot_m);
    for (double z_m = 0.05; z_m < 2; z_m += kCell_m) {
      segment.cells.push_back(Eigen::Vector3d(x_m, y_m, z_m).cast<float>());
      for (int i = 0; i < cell_points; ++i) segment.stats.Add({x_m, y_m + noise(random), z_m});
    }
  }
  segment.plane = FitPlane(segment.stats, -Eigen::Vector3d::UnitY()).plane;
  return segment;
}

size_t Left(const Segment& beside, double noise_m = 0.025) {
  std::vector<Segment> segments = {beside, Wall(0, 4, 0, 0, 40, noise_m)};
  DropBridges(&segments);
  EXPECT_NEAR(segments.back().stats.centroid().x(), 2, 0.01) << "the larger one stays";
  return segments.size();
}

constexpr double kTen_deg = 0.1745;

TEST(DropBridges, DropsWhatLeansFromAWallToAPillarBeforeIt) { EXPECT_EQ(Left(Wall(3.8, 4.3, 3.9, kTen_deg, 40)), 1u); }

TEST(DropBridges, KeepsAWallThatTurnsAwayFromItsNeighbour) {
  EXPECT_EQ(Left(Wall(4, 6, 4, kTen_deg, 40)), 2u);
  EXPECT_EQ(Left(Wall(4, 5, 4, 0.052, 40)), 2u) << "1 m built 3 degrees off";
}

// Wherever the frame's origin is.
TEST(DropBridges, KeepsWallsBeyondACorner) {
  for (double length_m : {0.6, 0.8, 1.0}) {
    for (double shift_m = 0; shift_m < 0.5; shift_m += 0.05) {
      std::vector<Segment> segments = {Wall(shift_m + 4, shift_m + 4 + length_m, shift_m + 4, 0.1, 40),
                                       Wall(shift_m, shift_m + 4, 0, 0, 80)};
      DropBridges(&segments);
      EXPECT_EQ(segments.size(), 2u) << length_m << " m, " << shift_m;
    }
  }
}

TEST(DropBridges, KeepsADoorLeafBeforeItsWall) { EXPECT_EQ(Left(Wall(1.5, 2.4, 1.5 - 0.05 / std::tan(0.04), 0.04, 40)), 2u); }

TEST(DropBridges, KeepsWhatGoesOnStraight) { EXPECT_EQ(Left(Wall(3.8, 4.3, 3.9, 0.01, 40)), 2u); }

TEST(DropBridges, KeepsWhatTheNoiseDoesNotReach) { EXPECT_EQ(Left(Wall(3.8, 4.3, 3.9, kTen_deg, 40, 0.004), 0.004), 2u); }

TEST(DropBridges, KeepsTheSameElsewhere) { EXPECT_EQ(Left(Wall(6, 6.5, 6, kTen_deg, 40)), 2u); }

TEST(DropBridges, KeepsTheOrder) {
  std::vector<Segment> segments = {Wall(3.8, 4.3, 3.9, kTen_deg, 40), Wall(6, 6.5, 6, kTen_deg, 40), Wall(0, 4, 0, 0, 40),
                                   Wall(8, 9, 8, 0, 40)};
  DropBridges(&segments);
  ASSERT_EQ(segments.size(), 3u);
  EXPECT_NEAR(segments[0].stats.centroid().x(), 6.25, 0.01);
  EXPECT_NEAR(segments[1].stats.centroid().x(), 2, 0.01);
  EXPECT_NEAR(segments[2].stats.centroid().x(), 8.5, 0.01);
}

}  // namespace
}  // namespace plumb::runtime
