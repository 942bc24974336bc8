#include "schema/polygon.h"

#include <gtest/gtest.h>

#include <limits>

namespace plumb {
namespace {

Room RoomWithHole() {
  Room room;
  room.polygon = {{0, 0}, {4, 0}, {4, 3}, {2, 3}, {2, 1}, {0, 1}};  // an L
  room.holes = {{{2.5, 0.2}, {2.5, 0.8}, {3.5, 0.8}, {3.5, 0.2}}};
  room.floor_z_m = 3;
  room.ceiling_z_m = 5.5;
  return room;
}

TEST(Polygon, ContainsWhatIsInsideAndNotTheNotch) {
  const Room room = RoomWithHole();
  EXPECT_TRUE(Contains(room.polygon, {0.5, 0.5}));
  EXPECT_TRUE(Contains(room.polygon, {3, 2.5}));
  EXPECT_FALSE(Contains(room.polygon, {1, 2}));
  EXPECT_FALSE(Contains(room.polygon, {-0.1, 0.5}));
  EXPECT_FALSE(Contains(Ring(), {0, 0}));
}

TEST(Polygon, RoomsDoNotContainTheirHoles) {
  EXPECT_TRUE(Contains(RoomWithHole().polygon, {3, 0.5}));
  EXPECT_FALSE(Contains(RoomWithHole(), {3, 0.5}));
}

TEST(Polygon, DistanceToARingIsThatToItsNearestEdgeFromEitherSide) {
  const Ring ring = RoomWithHole().polygon;
  EXPECT_DOUBLE_EQ(DistanceToRing(ring, {3, 1.5}), 1);
  EXPECT_DOUBLE_EQ(DistanceToRing(ring, {-3, -4}), 5);
  EXPECT_DOUBLE_EQ(DistanceToRing(ring, {0, 0.5}), 0);  // on the edge from the last corner to the first
  EXPECT_EQ(DistanceToRing(Ring(), {0, 0}), std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(DistanceToSegment({3, 4}, {0, 0}, {0, 0}), 5);  // a point
}

TEST(Polygon, RoomAtAsksForTheHeightToo) {
  AGraph graph;
  graph.rooms = {RoomWithHole(), RoomWithHole()};
  graph.rooms[1].floor_z_m = 6;
  graph.rooms[1].ceiling_z_m = 8.5;
  EXPECT_EQ(RoomAt(graph, {0.5, 0.5, 3.6}), RoomId(0));
  EXPECT_EQ(RoomAt(graph, {0.5, 0.5, 2.8}), RoomId(0));
  EXPECT_EQ(RoomAt(graph, {0.5, 0.5, 6.6}), RoomId(1));
  EXPECT_FALSE(RoomAt(graph, {0.5, 0.5, 9}).valid());
  EXPECT_FALSE(RoomAt(graph, {3, 0.5, 3.6}).valid());
}

}  // namespace
}  // namespace plumb
