#include "compiler/validate_graph.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/house.h"

namespace plumb::compiler {
namespace {

size_t CountOf(const AGraph& graph, DiagnosticKind kind) {
  const std::vector<Diagnostic> found = ValidateGraph(graph);
  return static_cast<size_t>(std::count_if(found.begin(), found.end(), [kind](const Diagnostic& d) { return d.kind == kind; }));
}

TEST(ValidateGraph, AGoodHouseIsClean) {
  const std::vector<Diagnostic> found = ValidateGraph(test::MakeHouse());
  for (const Diagnostic& d : found) ADD_FAILURE() << CodeOf(d.kind) << " " << d.message;
}

TEST(ValidateGraph, FindsRoomsThatAreNoPolygons) {
  AGraph g = test::MakeHouse();
  std::swap(g.rooms[0].polygon[0], g.rooms[0].polygon[1]);
  EXPECT_EQ(CountOf(g, DiagnosticKind::kRoomUnclosed), 1u);
  g = test::MakeHouse();
  g.rooms[0].polygon.resize(2);
  EXPECT_EQ(CountOf(g, DiagnosticKind::kRoomUnclosed), 1u);
  g = test::MakeHouse();
  g.rooms[0].area_m2 *= 2;
  EXPECT_EQ(CountOf(g, DiagnosticKind::kRoomUnclosed), 1u);
}

TEST(ValidateGraph, FindsOverlappingRooms) {
  AGraph g = test::MakeHouse();
  for (auto& p : g.rooms[1].polygon) p.y() -= 1;
  EXPECT_EQ(CountOf(g, DiagnosticKind::kRoomsOverlap), 1u);
}

TEST(ValidateGraph, FindsRoomsWithoutDoorwaySurfacesOrHeight) {
  AGraph g = test::MakeHouse();
  std::erase_if(g.doorways, [](const Doorway& d) { return d.name == "D2"; });
  EXPECT_EQ(CountOf(g, DiagnosticKind::kRoomWithoutDoorway), 1u);
  g = test::MakeHouse();
  g.rooms[2].surfaces.clear();
  EXPECT_EQ(CountOf(g, DiagnosticKind::kRoomWithoutSurfaces), 1u);
  EXPECT_EQ(CountOf(g, DiagnosticKind::kSurfaceUnclaimed), 4u);
  g = test::MakeHouse();
  g.rooms[2].ceiling_z_m = -1;
  EXPECT_EQ(CountOf(g, DiagnosticKind::kRoomUpsideDown), 1u);
}

TEST(ValidateGraph, FindsDoorwaysThatJoinNothing) {
  AGraph g = test::MakeHouse();
  g.doorways[0].room_a = g.doorways[0].room_b = RoomId();
  EXPECT_EQ(CountOf(g, DiagnosticKind::kDoorwayWithoutRoom), 1u);
  g = test::MakeHouse();
  g.doorways[0].room_b = g.doorways[0].room_a;
  EXPECT_EQ(CountOf(g, DiagnosticKind::kDoorwayWithoutRoom), 1u);
}

TEST(ValidateGraph, FindsSurfacesOffTheirRoom) {
  AGraph g = test::MakeHouse();
  const size_t s = g.rooms[0].surfaces[0].index();
  g.surfaces[s].start.y() -= 0.1;
  EXPECT_EQ(CountOf(g, DiagnosticKind::kSurfaceOffRoom), 1u);
  g = test::MakeHouse();
  g.surfaces[s].normal *= -1;
  EXPECT_EQ(CountOf(g, DiagnosticKind::kSurfaceOffRoom), 1u);
  g = test::MakeHouse();
  g.surfaces[s].room = RoomId();  // still listed, and faces the room
  EXPECT_EQ(CountOf(g, DiagnosticKind::kSurfaceUnclaimed), 2u);
}

TEST(ValidateGraph, FindsOpeningsOffTheirWall) {
  AGraph g = test::MakeHouse();
  g.doorways[1].position.x() += 2;
  g.doorways[2].wall = WallId();
  EXPECT_EQ(CountOf(g, DiagnosticKind::kOpeningOffWall), 2u);
}

TEST(ValidateGraph, FindsEmptyPlans) {
  AGraph g = test::MakeHouse();
  g.mesh.triangles.clear();
  EXPECT_EQ(CountOf(g, DiagnosticKind::kNoTriangles), 1u);
  EXPECT_EQ(CountOf(AGraph{}, DiagnosticKind::kNoRooms), 1u);
  g = test::MakeHouse();
  g.walls.emplace_back();
  EXPECT_EQ(CountOf(g, DiagnosticKind::kWallWithoutSurfaces), 1u);
}

TEST(ValidateGraph, FindsStoreysWhoseWallsAreAllParallel) {
  AGraph g = test::MakeHouse();
  std::erase_if(g.rooms, [](const Room&) { return true; });
  g.doorways.clear();
  for (Surface& s : g.surfaces) s.room = RoomId();
  std::erase_if(g.surfaces, [](const Surface& s) { return std::abs(s.normal.x()) > 0.5; });
  EXPECT_EQ(CountOf(g, DiagnosticKind::kWallsInOneDirection), 1u);
  EXPECT_EQ(CountOf(g, DiagnosticKind::kNowhereToLocalize), 1u);
  g.surfaces[0].arc = Arc{{0, 0}, 3, 0, 1};
  EXPECT_EQ(CountOf(g, DiagnosticKind::kWallsInOneDirection), 0u);
  EXPECT_EQ(CountOf(g, DiagnosticKind::kNowhereToLocalize), 0u);
}

}  // namespace
}  // namespace plumb::compiler
