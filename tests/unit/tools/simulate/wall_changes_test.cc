#include "tools/simulate/wall_changes.h"

#include <gtest/gtest.h>

#include "tests/support/house.h"

namespace plumb::tools {
namespace {

AsBuilt House() {
  SimulateOptions options;
  options.deviate = 0;
  return *BuildWithDeviations(test::MakeHouse(), StoreyId(0), options);
}

TEST(LeaveOutWalls, TakesOutWallsBetweenRoomsWithAllThatTheyHost) {
  const AGraph plan = test::MakeHouse();
  AsBuilt built = House();
  ASSERT_TRUE(LeaveOutWalls(plan, StoreyId(0), 2, 1, built));
  ASSERT_EQ(built.missing.size(), 2u);  // the only ones between rooms
  EXPECT_EQ(plan.walls[built.missing[0].index()].guid, "wall-middle");
  EXPECT_EQ(plan.walls[built.missing[1].index()].guid, "wall-across");
  for (const Triangle& t : built.house.mesh.triangles) {
    const WallId wall = built.house.elements[t.element].wall;
    EXPECT_TRUE(wall != built.missing[0] && wall != built.missing[1]);
  }
  AsBuilt again = House();
  EXPECT_EQ(LeaveOutWalls(plan, StoreyId(0), 3, 1, again).error().code, ErrorCode::kPlanUnsuitable);
}

TEST(LeaveOutWalls, LeavesWallsThatDeviate) {
  AsBuilt built = House();
  built.motions[4].translate(Eigen::Vector2d(0.1, 0));  // wall-middle
  ASSERT_TRUE(LeaveOutWalls(test::MakeHouse(), StoreyId(0), 1, 1, built));
  EXPECT_EQ(built.missing.front(), WallId(5));
}

TEST(AddWalls, StandInARoomFromFloorToCeilingAndLeaveAWayPast) {
  const AGraph plan = test::MakeHouse();
  AsBuilt built = House();
  const size_t elements = built.house.elements.size();
  ASSERT_TRUE(AddWalls(plan, StoreyId(0), 1, 7, built));
  ASSERT_EQ(built.unplanned.size(), 1u);
  EXPECT_EQ(built.unplanned[0].element, elements);
  EXPECT_NEAR(built.unplanned[0].height_m, test::kHouseHeight_m, 1e-9);
  EXPECT_GE(2 * built.unplanned[0].footprint.half_length_m, 1.2);
  EXPECT_EQ(FindReach(built.house, StoreyId(0), FreeSpace(built.house, StoreyId(0), built.passages)).reachable(), 3u);
  AsBuilt again = House();
  EXPECT_EQ(AddWalls(plan, StoreyId(0), 50, 7, again).error().code, ErrorCode::kPlanUnsuitable);
}

TEST(PassesThrough, OnlyWhatGoesRightThrough) {
  WallBody body;
  body.footprint = {{0, 0}, {1, 0}, 2, 0.1};
  body.z_max_m = 2.5;
  EXPECT_TRUE(PassesThrough(body, {0, -1, 1}, {0.5, 1, 1}));
  EXPECT_FALSE(PassesThrough(body, {0, -1, 1}, {0.5, -0.5, 1}));  // ends before it
  EXPECT_FALSE(PassesThrough(body, {0, -1, 1}, {0, 0.05, 1}));    // ends in it
  EXPECT_FALSE(PassesThrough(body, {3, -1, 1}, {3, 1, 1}));       // beside it
  EXPECT_FALSE(PassesThrough(body, {0, -1, 3}, {0, 1, 3}));       // over it
}

}  // namespace
}  // namespace plumb::tools
