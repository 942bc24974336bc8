#include "runtime/matching/walks.h"

#include <gtest/gtest.h>

#include "tests/support/house.h"
#include "tests/support/plans.h"

namespace plumb::runtime {
namespace {

TEST(Walks, EnterTheRoomsNextDoorNearestFirst) {
  const AGraph house = test::MakeHouse();
  const std::vector<WalkStop> stops = WalksFrom(house, {2.45, 1.0, 0.6}, 40, 24);
  ASSERT_GE(stops.size(), 2u);
  EXPECT_EQ(house.rooms[stops[0].room.index()].name, "B");
  EXPECT_NEAR(stops[0].distance_m, 3.5 + 0.06 + 0.4 - 1.0, 1e-9);
  EXPECT_EQ(stops[0].before, -1);
  EXPECT_EQ(house.rooms[stops[1].room.index()].name, "C");
  for (const WalkStop& stop : stops) EXPECT_TRUE(stop.room.valid()) << "D3 leads outside";
}

TEST(Walks, LeadThroughSeveralRoomsAsFarAsAsked) {
  const AGraph plan = test::MakeGridPlan({0, 4, 8, 12, 16}, {0, 4}, {{true, 1, 0, 0.5}, {true, 2, 0, 0.5}, {true, 3, 0, 0.5}});
  const Eigen::Vector3d start(2, 2, 0.6);
  std::vector<double> distances_m;
  std::vector<RoomId> rooms;
  for (const WalkStop& stop : WalksFrom(plan, start, 40, 24)) {
    if (stop.distance_m > 11) break;  // and back
    rooms.push_back(stop.room);
    distances_m.push_back(stop.distance_m);
  }
  EXPECT_EQ(rooms, (std::vector{RoomId(1), RoomId(2), RoomId(3)}));
  ASSERT_EQ(distances_m.size(), 3u);
  EXPECT_NEAR(distances_m[2], 10.5, 1e-9);
  EXPECT_EQ(WalksFrom(plan, start, 7, 24).size(), 2u);
  EXPECT_EQ(WalksFrom(plan, start, 40, 1).size(), 1u);
}

TEST(Walks, BeginInADoorwayToBothSides) {
  const AGraph plan = test::MakeGridPlan({0, 4, 8}, {0, 4}, {{true, 1, 0, 0.5}});
  EXPECT_EQ(WalksFrom(plan, {4, 2, 0.6}, 3, 24).size(), 2u);
  EXPECT_TRUE(WalksFrom(plan, {-3, 2, 0.6}, 40, 24).empty()) << "outside";
}

}  // namespace
}  // namespace plumb::runtime
