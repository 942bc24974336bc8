#include "runtime/odometry/surfel_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {
namespace {

// A patch of the plane x = x_m about (y, z) = (0.1, 0.1), with alternating noise, seen from `sensor`.
void AddWall(SurfelMap* map, double x_m, const Eigen::Vector3d& sensor, double noise_m = 0.01) {
  int sign = 1;
  for (double y = -1; y < 1; y += 0.05) {
    for (double z = -1; z < 1; z += 0.07, sign = -sign) map->Insert({x_m + sign * noise_m, y, z}, sensor);
  }
  map->EndScan();
}

TEST(VoxelIndex, NumbersKeysInOrderOfInsertion) {
  VoxelIndex index;
  for (uint64_t i = 0; i < 5000; ++i) EXPECT_EQ(index.Insert(i * 977).first, i);
  for (uint64_t i = 0; i < 5000; ++i) EXPECT_EQ(index.Find(i * 977), i);
  EXPECT_FALSE(index.Insert(977).second);
  EXPECT_EQ(index.Find(1), VoxelIndex::kNone);
}

TEST(VoxelIndex, KeysDifferAcrossZero) {
  EXPECT_NE(VoxelKey({-0.5, 0.5, 0.5}), VoxelKey({0.5, 0.5, 0.5}));
  EXPECT_NE(VoxelKey({0.5, -0.5, 0.5}), VoxelKey({0.5, 0.5, -0.5}));
}

TEST(SurfelMap, TwoFacesOfAThinWallStayApart) {
  SurfelMap map;
  const Eigen::Vector3d west(-2, 0, 0), east(2, 0, 0);
  AddWall(&map, 0.00, west);
  AddWall(&map, 0.11, east);
  int west_faces = 0, east_faces = 0;
  for (const Surfel& s : map.surfels()) {
    if (!s.planar) continue;
    const bool faces_west = s.normal.x() < 0;
    EXPECT_NEAR(s.mean.x(), faces_west ? 0.0 : 0.11, 0.004);
    EXPECT_GT(std::abs(s.normal.x()), 0.99);
    (faces_west ? west_faces : east_faces) += 1;
  }
  EXPECT_GT(west_faces, 8);
  EXPECT_GT(east_faces, 8);
  const Surfel* seen_from_west = map.Nearest({0.07, 0.1, 0.1}, west, true);
  ASSERT_NE(seen_from_west, nullptr);
  EXPECT_NEAR(seen_from_west->mean.x(), 0.0, 0.004);
}

TEST(SurfelMap, LinesAndCloudsAreNoSurfels) {
  SurfelMap map;
  for (double y = -1; y < 1; y += 0.01) map.Insert({1, y, 0}, Eigen::Vector3d::Zero());
  map.EndScan();
  std::mt19937_64 rng(1);
  const auto uniform = [&] { return static_cast<double>(rng() >> 11) * 0x1p-53; };
  for (int i = 0; i < 2000; ++i) map.Insert({5 + uniform(), uniform(), uniform()}, Eigen::Vector3d::Zero());
  map.EndScan();
  for (const Surfel& s : map.surfels()) EXPECT_FALSE(s.planar && s.count > 50) << s.mean.transpose();
}

TEST(SurfelMap, ForgetsWhatWasUnseenForLongest) {
  SurfelMapOptions options;
  options.max_voxels = 1000;
  SurfelMap map(options);
  for (int wall = 0; wall < 60; ++wall) AddWall(&map, 2.0 * wall, {2.0 * wall - 1, 0, 0});
  EXPECT_LE(map.num_voxels(), 1000u);
  EXPECT_EQ(map.Nearest({0, 0.1, 0.1}, {-1, 0, 0}, true), nullptr);
  EXPECT_NE(map.Nearest({118, 0.1, 0.1}, {117, 0, 0}, true), nullptr);
}

TEST(SurfelMap, DistanceVarianceGrowsAwayFromThePoints) {
  SurfelMap map;
  AddWall(&map, 0, {-2, 0, 0}, 0.02);
  const Surfel* s = map.Nearest({0, 0.1, 0.1}, {-2, 0, 0}, true);
  ASSERT_NE(s, nullptr);
  const double at_mean_m2 = s->DistanceVariance(s->mean, 0.02);
  EXPECT_NEAR(at_mean_m2, 4e-4 * (1 + 1 / s->count), 1e-4);
  EXPECT_GT(s->DistanceVariance(s->mean + 2 * s->major, 0.02), 1.5 * at_mean_m2);
}

}  // namespace
}  // namespace plumb::runtime
