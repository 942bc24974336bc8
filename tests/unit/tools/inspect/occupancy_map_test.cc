#include "tools/inspect/occupancy_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/house.h"

namespace plumb::tools {
namespace {

using ::testing::HasSubstr;

OccupancyMap MapOf(const AGraph& graph, const OccupancyOptions& options = {}) {
  auto map = MakeOccupancyMap(graph, StoreyId(0), options);
  EXPECT_TRUE(map) << map.error().message;
  return map.value_or(OccupancyMap{});
}

// As map_server turns a pose into a cell.
Occupancy CellAt(const OccupancyMap& map, double x_m, double y_m) {
  const auto column = static_cast<size_t>(std::floor((x_m - map.origin.x()) / map.resolution_m));
  const auto row = static_cast<size_t>(std::floor((y_m - map.origin.y()) / map.resolution_m));
  EXPECT_LT(column, map.columns);
  EXPECT_LT(row, map.rows);
  return map.at(column, row);
}

TEST(OccupancyMap, RoomsAreFreeWallsOccupiedTheRestUnknown) {
  const OccupancyMap map = MapOf(test::MakeHouse());
  EXPECT_EQ(CellAt(map, 1, 1), Occupancy::kFree);          // room A
  EXPECT_EQ(CellAt(map, 7, 3), Occupancy::kFree);          // room C
  EXPECT_EQ(CellAt(map, -0.15, 5), Occupancy::kOccupied);  // within the west wall
  EXPECT_EQ(CellAt(map, 5, 5), Occupancy::kOccupied);      // within the middle wall
  EXPECT_EQ(CellAt(map, 8.7, 0.2), Occupancy::kOccupied);  // the chimney
  EXPECT_EQ(CellAt(map, -0.6, 3), Occupancy::kUnknown);
  EXPECT_EQ(CellAt(map, 4, -0.5), Occupancy::kUnknown);
}

TEST(OccupancyMap, DoorsStandOpen) {
  const OccupancyMap map = MapOf(test::MakeHouse());
  for (double x = -0.3; x < 0.1; x += 0.02) EXPECT_EQ(CellAt(map, x, 1.65), Occupancy::kFree) << x;  // D3 has a leaf
  for (double y = 3.3; y < 3.7; y += 0.02) EXPECT_EQ(CellAt(map, 2.45, y), Occupancy::kFree) << y;
  EXPECT_EQ(CellAt(map, -0.15, 1.15), Occupancy::kOccupied);  // beside the opening
  // One that the wall's solid does not leave open.
  AGraph house = test::MakeHouse();
  test::AddDoorway(house, "D4", WallId(1), RoomId(2), RoomId(), {9.15, 3}, 0, true);
  EXPECT_EQ(CellAt(MapOf(house), 9.15, 3), Occupancy::kFree);
  EXPECT_EQ(CellAt(map, 9.15, 3), Occupancy::kOccupied);
}

TEST(OccupancyMap, IsCutAtTheSensorsHeight) {
  AGraph house = test::MakeHouse();
  test::AddBox(house, {6.5, 2, 0}, {7.5, 3, 0.75}, test::AddElement(house, "table", ElementKind::kFurniture));
  EXPECT_EQ(CellAt(MapOf(house, {.height_m = 0.5}), 7, 2.5), Occupancy::kOccupied);
  EXPECT_EQ(CellAt(MapOf(house, {.height_m = 1.0}), 7, 2.5), Occupancy::kFree);
  EXPECT_EQ(CellAt(MapOf(house, {.height_m = 2.3}), 0, 1.65), Occupancy::kFree);  // a doorway stays one above its lintel
}

TEST(OccupancyMap, HeightCountsFromTheRoomsFloor) {
  AGraph house = test::MakeHouse();
  test::AddBox(house, {6.5, 2, 0}, {7.5, 3, 0.75}, test::AddElement(house, "table", ElementKind::kFurniture));
  for (Room& r : house.rooms) r.floor_z_m = 0.5;
  EXPECT_EQ(CellAt(MapOf(house, {.height_m = 0.5}), 7, 2.5), Occupancy::kFree);
}

TEST(OccupancyMap, AWallThinnerThanACellIsNotLost) {
  AGraph house = test::MakeHouse();
  test::AddBox(house, {6, 1.001, 0}, {8, 1.004, 2}, test::AddElement(house, "pane", ElementKind::kWindow));
  const OccupancyMap map = MapOf(house, {.resolution_m = 0.1});
  for (double x = 6.05; x < 8; x += 0.1) EXPECT_EQ(CellAt(map, x, 1.0025), Occupancy::kOccupied) << x;
}

TEST(OccupancyMap, SlantedLinesHaveNoHoles) {
  AGraph house = test::MakeHouse();
  // A sheet without thickness, steep: every row between its ends is crossed.
  const auto base = static_cast<uint32_t>(house.mesh.vertices.size());
  for (const auto& [x, y, z] : {std::tuple(6.03F, 1.02F, 0.F), {6.71F, 4.33F, 0.F}, {6.71F, 4.33F, 2.F}, {6.03F, 1.02F, 2.F}})
    house.mesh.vertices.emplace_back(x, y, z);
  const uint32_t element = test::AddElement(house, "sheet", ElementKind::kFurniture);
  house.mesh.triangles.push_back({base, base + 1, base + 2, element});
  house.mesh.triangles.push_back({base, base + 2, base + 3, element});
  const OccupancyMap map = MapOf(house);
  for (double t = 0; t <= 1; t += 0.002) EXPECT_EQ(CellAt(map, 6.03 + t * 0.68, 1.02 + t * 3.31), Occupancy::kOccupied) << t;
  EXPECT_EQ(CellAt(map, 6.2, 3.5), Occupancy::kFree);
}

TEST(OccupancyMap, LiesWhereThePlanDoesFarFromZero) {
  AGraph house = test::MakeHouse();
  const Eigen::Vector2d far(691000, 5335000);
  house.origin.head<2>() += far;
  for (Wall& w : house.walls) w.axis_start += far, w.axis_end += far;
  for (Surface& s : house.surfaces) s.start += far, s.end += far;
  for (Room& r : house.rooms) {
    for (auto& p : r.polygon) p += far;
  }
  for (Doorway& d : house.doorways) d.position.head<2>() += far;
  const OccupancyMap map = MapOf(house), here = MapOf(test::MakeHouse());
  EXPECT_EQ(CellAt(map, far.x() + 1, far.y() + 1), Occupancy::kFree);
  EXPECT_EQ(CellAt(map, far.x() - 0.15, far.y() + 5), Occupancy::kOccupied);
  EXPECT_NEAR(map.origin.x() - here.origin.x(), far.x(), 0.0501);
}

TEST(OccupancyMap, FilesAreAsMapServerReadsThem) {
  const OccupancyMap map = MapOf(test::MakeHouse());
  const std::string pgm = MapPgm(map), header = "P5\n" + std::to_string(map.columns) + " " + std::to_string(map.rows) + "\n255\n";
  EXPECT_THAT(pgm, ::testing::StartsWith(header));
  ASSERT_EQ(pgm.size(), header.size() + map.columns * map.rows);
  // The last line of the image is the lowest row of the map.
  const auto pixel = [&](size_t column, size_t row) {
    return static_cast<uint8_t>(pgm[header.size() + (map.rows - 1 - row) * map.columns + column]);
  };
  for (size_t row = 0; row < map.rows; row += 7) {
    for (size_t column = 0; column < map.columns; column += 5) {
      const double occupied = (255 - pixel(column, row)) / 255.0;
      const Occupancy read = occupied > 0.65 ? Occupancy::kOccupied : occupied < 0.196 ? Occupancy::kFree : Occupancy::kUnknown;
      EXPECT_EQ(read, map.at(column, row));
    }
  }
  // 0.3 m of wall and 0.5 m of border.
  EXPECT_EQ(MapYaml(map, "map.pgm"),
            "image: map.pgm\nmode: trinary\nresolution: 0.05\norigin: [-0.800000, -0.800000, 0.0]\nnegate: 0\noccupied_thresh: "
            "0.65\nfree_thresh: 0.196\n");
}

TEST(OccupancyMap, RefusesBadOptionsAndEmptyStoreys) {
  AGraph house = test::MakeHouse();
  EXPECT_EQ(MakeOccupancyMap(house, StoreyId(0), {.resolution_m = 0}).error().code, ErrorCode::kBadOption);
  EXPECT_EQ(MakeOccupancyMap(house, StoreyId(0), {.height_m = -1}).error().code, ErrorCode::kBadOption);
  EXPECT_EQ(MakeOccupancyMap(house, StoreyId(0), {.max_cells = 1000}).error().code, ErrorCode::kBadOption);
  house.storeys.push_back({"s1", "Empty", 3, 3});
  const auto map = MakeOccupancyMap(house, StoreyId(1));
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().code, ErrorCode::kPlanUnsuitable);
  EXPECT_THAT(map.error().message, HasSubstr("Empty"));
}

}  // namespace
}  // namespace plumb::tools
