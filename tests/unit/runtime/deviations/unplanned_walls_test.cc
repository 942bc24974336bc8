#include "runtime/deviations/unplanned_walls.h"

#include <gtest/gtest.h>

#include <numbers>

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

// A partition is planned in room C, at y from 3.3 to 3.42 ...
AGraph PlannedInC() {
  AGraph plan = test::MakeHouse();
  const WallId wall = test::AddWall(plan, "wall-in-C", {5.06, 3.3}, {7.2, 3.42});
  test::AddSurface(plan, wall, RoomId(2), {5.06, 3.3}, {7.2, 3.3});
  test::AddSurface(plan, wall, RoomId(2), {7.2, 3.42}, {5.06, 3.42});
  return plan;
}

// ... and built further north, turned about its middle.
AGraph PartitionInC(double offset_m, double turn_deg) {
  AGraph built = PlannedInC();
  const Eigen::Vector2d middle(6.13, 3.36);
  test::Displace(built, "wall-in-C",
                 Eigen::Translation2d(middle + Eigen::Vector2d(0, offset_m)) * Eigen::Rotation2Dd(turn_deg * std::numbers::pi / 180) *
                     Eigen::Translation2d(-middle));
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

TEST(FindUnplannedWalls, APlannedWallThatStandsTooFarOffToBeRecognizedIsNone) {
  for (const auto& [offset_m, turn_deg] : {std::pair{0.4, 8.0}, {0.55, 15.0}, {0.6, 25.0}}) {
    const AGraph built = PartitionInC(offset_m, turn_deg);
    EXPECT_EQ(Unplanned(test::MakeHouse(), built).size(), 1u) << "where no wall is planned";
    EXPECT_TRUE(Unplanned(PlannedInC(), built).empty()) << offset_m << " m, " << turn_deg << " deg";
  }
}

TEST(FindUnplannedWalls, BesideAPlannedWallThatWasRecognizedAnotherOneIsFound) {
  const AGraph house = test::MakeHouse();
  test::Survey s = test::DriveThrough(house, PartitionInC(0.55, 15));
  const AGraph plan = PlannedInC();
  ASSERT_FALSE(s.matches.empty());
  Match match = s.matches.front();
  match.plan_surface = SurfaceId(plan.surfaces.size() - 1);
  s.matches.push_back(match);
  EXPECT_EQ(FindUnplannedWalls(s.map, plan, s.matches, s.estimate).size(), 1u);
}

UnplannedWall Box(double x0, double y0, double x1, double y1) { return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, 2.5, RoomId(0)}; }

TEST(SameWall, IsOneOnOneLineHoweverMuchOfItWasSeen) {
  const UnplannedWall whole = Box(0, 0, 4, 0.12);
  EXPECT_TRUE(SameWall(whole, whole));
  EXPECT_TRUE(SameWall(whole, Box(2.1, 0.03, 4, 0.15)));
  EXPECT_TRUE(SameWall(Box(2.1, 0.03, 4, 0.15), whole));
  EXPECT_FALSE(SameWall(whole, Box(0, 0.4, 4, 0.52))) << "beside it";
  EXPECT_FALSE(SameWall(whole, Box(4.9, 0, 6, 0.12))) << "beyond a doorway";
  EXPECT_FALSE(SameWall(whole, Box(1.9, -1, 2.02, 1))) << "across";
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
