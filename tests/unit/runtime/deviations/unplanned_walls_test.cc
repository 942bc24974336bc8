#include "runtime/deviations/unplanned_walls.h"

#include <gtest/gtest.h>

#include "tests/unit/runtime/deviations/built_house.h"

namespace plumb::runtime {
namespace {

std::vector<UnplannedWall> Unplanned(const AGraph& plan, const AGraph& as_built) {
  const test::Survey s = test::DriveThrough(plan, as_built);
  return FindUnplannedWalls(s.map, plan, s.matches, s.estimate);
}

// The house with a box in it.
AGraph With(const Eigen::Vector3d& lo, const Eigen::Vector3d& hi) {
  AGraph built = test::MakeHouse();
  test::AddThing(built, lo, hi);
  return built;
}

TEST(FindUnplannedWalls, ThereAreNoneInTheHouseAsPlanned) {
  const AGraph house = test::MakeHouse();
  EXPECT_TRUE(Unplanned(house, house).empty());
}

TEST(FindUnplannedWalls, BothFacesOfAPartitionAreOneWall) {
  const AGraph house = test::MakeHouse();
  const std::vector<UnplannedWall> walls = Unplanned(house, With({5.06, 3.9, 0}, {7.2, 4.02, 2.6}));
  ASSERT_EQ(walls.size(), 1u);
  ASSERT_EQ(walls[0].polygon.size(), 4u);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : walls[0].polygon) box.extend(p);
  EXPECT_NEAR(box.min().y(), 3.9, 0.03);
  EXPECT_NEAR(box.max().y(), 4.02, 0.03);
  EXPECT_NEAR(box.min().x(), 5.06, 0.3);
  EXPECT_NEAR(box.max().x(), 7.2, 0.3);
  EXPECT_GT(walls[0].height_m, 1.4);
  EXPECT_EQ(house.rooms[walls[0].room.index()].center.x() > 5, true);
}

TEST(FindUnplannedWalls, FurnitureIsNone) {
  const AGraph house = test::MakeHouse();
  EXPECT_TRUE(Unplanned(house, With({6.4, 3.5, 0}, {7.6, 4.1, 2.0})).empty()) << "cupboard";
  EXPECT_TRUE(Unplanned(house, With({6.0, 3.6, 0}, {7.6, 3.9, 1.8})).empty()) << "shelf";
  EXPECT_TRUE(Unplanned(house, With({6.0, 3.6, 0}, {7.6, 3.65, 1.3})).empty()) << "screen that one sees over";
  EXPECT_TRUE(Unplanned(house, With({6.5, 5.9, 0}, {8.5, 6.0, 2.0})).empty()) << "boards leant on a wall";
  EXPECT_TRUE(Unplanned(house, With({6.5, 5.4, 0}, {8.5, 6.0, 2.6})).empty()) << "wardrobe up to the ceiling, on a wall";
}

TEST(FindUnplannedWalls, WhatIsOutsideThePlanIsUnknownAndNotUnplanned) {
  const AGraph house = test::MakeHouse();
  AGraph smaller = house;
  smaller.rooms[2].polygon = {{5.06, 0}, {5.2, 0}, {5.2, 6}, {5.06, 6}};
  const test::Survey s = test::DriveThrough(house, With({5.06, 3.9, 0}, {7.2, 4.02, 2.6}));
  EXPECT_TRUE(FindUnplannedWalls(s.map, smaller, s.matches, s.estimate).empty());
}

TEST(FindUnplannedWalls, APlanarLaserFindsNone) {
  const AGraph house = test::MakeHouse();
  test::Survey s = test::DriveThrough(house, With({5.06, 3.9, 0}, {7.2, 4.02, 2.6}));
  s.map.planar = true;
  EXPECT_TRUE(FindUnplannedWalls(s.map, house, s.matches, s.estimate).empty());
}

TEST(UnplannedOptions, CheckNamesFieldValueAndRule) {
  EXPECT_EQ(UnplannedOptions{}.Check(), "");
  UnplannedOptions options;
  options.min_length_m = -1;
  EXPECT_EQ(options.Check(), "UnplannedOptions.min_length_m = -1; must be a positive number");
}

}  // namespace
}  // namespace plumb::runtime
