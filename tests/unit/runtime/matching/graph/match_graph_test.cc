#include "runtime/matching/graph/match_graph.h"

#include <gtest/gtest.h>

#include "tests/support/house.h"

namespace plumb::runtime {
namespace {

using Eigen::Vector2d;

// A rectangular room of a map: its surfaces from `surfaces` on.
MapRoom AddMapRoom(SGraph& map, const Vector2d& lo, const Vector2d& hi) {
  const Vector2d corners[4] = {{lo.x(), lo.y()}, {hi.x(), lo.y()}, {hi.x(), hi.y()}, {lo.x(), hi.y()}};
  MapRoom room;
  room.area_m2 = (hi - lo).prod();
  room.center = (lo + hi) / 2;
  for (size_t i = 0; i < 4; ++i) {
    MapSurface s;
    s.id = static_cast<uint32_t>(map.surfaces.size());
    s.start = corners[i];
    s.end = corners[(i + 1) % 4];
    const Vector2d along = (s.end - s.start).normalized();
    s.plane.n = {-along.y(), along.x(), 0};
    s.plane.d = -s.plane.n.head<2>().dot(s.start);
    s.observations.emplace_back();
    room.surfaces.push_back(s.id);
    map.surfaces.push_back(s);
  }
  return room;
}

TEST(PlanGraph, HasTheRoomsOfTheHouseWithTheirWalls) {
  AGraph house = test::MakeHouse();
  house.origin = {3, -2, 0};
  const MatchGraph graph = PlanGraph(house, StoreyId(0), GraphRooms::kFourWalls);
  ASSERT_EQ(graph.rooms.size(), 3u);
  EXPECT_NEAR((graph.rooms[0].center - (Vector2d(2.47, 1.72) - Vector2d(3, -2))).norm(), 0, 1e-9);
  for (const GraphRoom& room : graph.rooms) {
    ASSERT_EQ(room.walls.size(), 4u);
    for (size_t w : room.walls) EXPECT_GT(graph.walls[w].normal.dot(room.center) + graph.walls[w].d_m, 1) << "normals point into the room";
  }
  EXPECT_EQ(graph.Orphans().size(), 4u) << "the outer faces";
  EXPECT_TRUE(PlanGraph(house, StoreyId(1), GraphRooms::kFourWalls).rooms.empty());
}

TEST(PlanGraph, LeavesOutRoomsThatFourWallsDoNotBound) {
  AGraph house = test::MakeHouse();
  house.rooms[0].area_m2 *= 0.6;  // as if it had a corner cut off
  EXPECT_EQ(PlanGraph(house, StoreyId(0), GraphRooms::kFourWalls).rooms.size(), 2u);
  EXPECT_EQ(PlanGraph(house, StoreyId(0), GraphRooms::kAny).rooms.size(), 3u);
}

TEST(MapGraph, TakesTheLongestOfEachSideAndJoinsPiecesOfOneWall) {
  SGraph map;
  UpperLayers layers;
  layers.floors.emplace_back();
  layers.rooms.push_back(AddMapRoom(map, {0, 0}, {4, 3}));
  // The south wall in two pieces beside a door, and a cupboard before it.
  MapSurface piece = map.surfaces[0];
  map.surfaces[0].end = {2.2, 0};
  piece.id = 4;
  piece.start = {3.1, 0.02};
  piece.end = {4, 0.02};
  MapSurface cupboard = piece;
  cupboard.id = 5;
  cupboard.start = {0.2, 0.6};
  cupboard.end = {1.2, 0.6};
  cupboard.plane.d = -0.6;
  map.surfaces.push_back(piece);
  map.surfaces.push_back(cupboard);
  layers.rooms[0].surfaces = {0, 1, 2, 3, 4, 5};
  const MatchGraph graph = MapGraph(map, layers, 0, GraphRooms::kFourWalls);
  ASSERT_EQ(graph.rooms.size(), 1u);
  std::vector<uint32_t> ids;
  for (size_t w : graph.rooms[0].walls) ids.push_back(graph.walls[w].id);
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(ids, (std::vector<uint32_t>{0, 1, 2, 3}));
  EXPECT_NEAR((graph.rooms[0].center - Vector2d(2, 1.5)).norm(), 0, 1e-9);
  EXPECT_EQ(graph.Orphans().size(), 2u);
  const MatchGraph any = MapGraph(map, layers, 0, GraphRooms::kAny);
  EXPECT_EQ(any.rooms.at(0).walls.size(), 5u) << "with the cupboard";
}

TEST(MapGraph, LeavesOutRoomsSeenInPartAndOtherFloors) {
  SGraph map;
  UpperLayers layers;
  layers.floors.resize(2);
  layers.rooms.push_back(AddMapRoom(map, {0, 0}, {4, 3}));
  layers.rooms.push_back(AddMapRoom(map, {5, 0}, {9, 3}));
  layers.rooms.push_back(AddMapRoom(map, {0, 0}, {4, 3}));
  layers.rooms[1].surfaces.pop_back();
  layers.rooms[2].floor = 1;
  EXPECT_EQ(MapGraph(map, layers, 0, GraphRooms::kFourWalls).rooms.size(), 1u);
  EXPECT_EQ(MapGraph(map, layers, 0, GraphRooms::kAny).rooms.size(), 2u);
  EXPECT_EQ(MapGraph(map, layers, 1, GraphRooms::kFourWalls).rooms.size(), 1u);
}

}  // namespace
}  // namespace plumb::runtime
