#include "runtime/odometry/leveling.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumb::runtime {
namespace {

constexpr double kMaxTilt_rad = 0.6;

SurfelMap Coarse() {
  SurfelMapOptions options;
  options.voxel_m = 1.0;
  return SurfelMap(options);
}

// A rectangle of points about `center`, `along` and `up` its half sides.
void AddPatch(const Eigen::Matrix3d& R, const Eigen::Vector3d& center, const Eigen::Vector3d& along, const Eigen::Vector3d& up,
              SurfelMap* map) {
  for (double a = -1; a <= 1; a += 0.04) {
    for (double b = -1; b <= 1; b += 0.1) map->Insert(R * (center + a * along + b * up), Eigen::Vector3d::Zero());
  }
}

// Four walls, as a lidar that sees no floor has them.
void AddWalls(const Eigen::Matrix3d& R, SurfelMap* map) {
  for (const double side : {-1.0, 1.0}) {
    AddPatch(R, {2 * side, 0, 0}, {0, 2, 0}, {0, 0, 0.6}, map);
    AddPatch(R, {0, 2 * side, 0}, {2, 0, 0}, {0, 0, 0.6}, map);
  }
}

double Off(const std::optional<Eigen::Vector3d>& found, const Eigen::Matrix3d& R) {
  return found ? std::acos(std::min(1.0, found->dot(R.col(2)))) : 9;
}

TEST(Leveling, FindsTheTiltFromTheFloorAlone) {
  SurfelMap map = Coarse();
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.1, Eigen::Vector3d(0.6, 0.8, 0)).toRotationMatrix();
  for (double x = -3; x < 3; x += 0.08) {
    for (double y = -3; y < 3; y += 0.09) map.Insert(R * Eigen::Vector3d(x, y, -1), Eigen::Vector3d::Zero());
  }
  map.EndScan();
  const std::optional<Eigen::Vector3d> found = FindUp(map, Eigen::Vector3d::UnitZ(), kMaxTilt_rad);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - R.col(2)).norm(), 1e-3);
  const Eigen::Matrix3d L = LevelingRotation(*found);
  EXPECT_LT((L * *found - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  EXPECT_NEAR(std::atan2(L(1, 0), L(0, 0)), 0, 1e-9);
}

TEST(Leveling, FindsTheTiltFromWallsAlone) {
  SurfelMap map;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(-0.08, Eigen::Vector3d(0.8, 0.6, 0)).toRotationMatrix();
  for (double a = -2; a < 2; a += 0.05) {
    for (double z = -1; z < 1; z += 0.06) {
      map.Insert(R * Eigen::Vector3d(2, a, z), Eigen::Vector3d::Zero());
      map.Insert(R * Eigen::Vector3d(a, 2, z), Eigen::Vector3d::Zero());
    }
  }
  map.EndScan();
  const std::optional<Eigen::Vector3d> found = FindUp(map, Eigen::Vector3d::UnitZ(), kMaxTilt_rad);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - R.col(2)).norm(), 3e-3);
}

TEST(Leveling, OneWallSaysNothing) {
  SurfelMap map = Coarse();
  AddPatch(Eigen::Matrix3d::Identity(), {2, 0, 0}, {0, 1, 0}, {0, 0, 1}, &map);
  map.EndScan();
  EXPECT_FALSE(FindUp(map, Eigen::Vector3d::UnitZ(), kMaxTilt_rad));
}

TEST(Leveling, WallsOutvoteAFloorThatABoxLeans) {
  for (const double lean : {0.12, 0.2}) {
    SurfelMap map = Coarse();
    const Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
    AddWalls(level, &map);
    AddPatch(level, {0.5, 0.4, -0.8}, {0.4, 0, 0.4 * std::tan(lean)}, {0, 0.4, 0}, &map);
    map.EndScan();
    EXPECT_LT(Off(FindUp(map, Eigen::Vector3d::UnitZ(), kMaxTilt_rad), level), 2e-3) << lean;
  }
}

TEST(Leveling, AWholeFloorIsLevelWhateverLeansAtIt) {
  SurfelMap map = Coarse();
  const Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
  AddPatch(level, {0, 0, -0.8}, {4, 0, 0}, {0, 4, 0}, &map);
  AddPatch(level, {1.2, 0, 0}, {0, 0.4, 0}, {0.1, 0, 0.5}, &map);  // two boards that lean
  AddPatch(level, {0, 1.3, 0}, {0.4, 0, 0}, {0, 0.1, 0.5}, &map);
  map.EndScan();
  EXPECT_LT(Off(FindUp(map, Eigen::Vector3d::UnitZ(), kMaxTilt_rad), level), 5e-3);
}

TEST(Leveling, SensorsMountedAtAnAngleAreLeveledWithinTheLimit) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.5, Eigen::Vector3d(0.8, -0.6, 0)).toRotationMatrix();
  SurfelMap map = Coarse();
  AddWalls(R, &map);
  AddPatch(R, {0.3, 0.2, -0.8}, {1.5, 0, 0}, {0, 1.5, 0}, &map);
  map.EndScan();
  EXPECT_LT(Off(FindUp(map, Eigen::Vector3d::UnitZ(), kMaxTilt_rad), R), 2e-3);
  EXPECT_FALSE(FindUp(map, Eigen::Vector3d::UnitZ(), 0.4));
}

TEST(Leveling, WhatIsExpectedChoosesAmongAxesOfARoom) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.06, Eigen::Vector3d(0.6, 0.8, 0)).toRotationMatrix();
  SurfelMap map = Coarse();
  AddWalls(R, &map);
  AddPatch(R, {0.3, 0.2, -0.8}, {1.5, 0, 0}, {0, 1.5, 0}, &map);
  map.EndScan();
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 0, 0)}) {
    const std::optional<Eigen::Vector3d> found = FindUp(map, axis, kMaxTilt_rad);
    ASSERT_TRUE(found) << axis.transpose();
    EXPECT_LT((*found - R * axis).norm(), 4e-3) << axis.transpose();
    EXPECT_LT((LevelingRotation(*found) * *found - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace plumb::runtime
