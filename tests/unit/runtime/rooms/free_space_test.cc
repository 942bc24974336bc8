#include "runtime/rooms/free_space.h"

#include <gtest/gtest.h>

#include <vector>

namespace plumb::runtime {
namespace {

// A sensor at (0, 0, 0.6) that looks along +y; floor at z = 0.
struct Scene {
  SGraph graph;
  MapFloor floor;

  Scene() {
    graph.keyframes.emplace_back().T_map_kf.translation().z() = 0.6;
    floor.sensor_z_m = 0.6;
    floor.floor_z_m = 0;
    floor.keyframes = {0};
  }
  // Points at distance y and height z, all over the quarter turn ahead.
  void See(double y, double z_m) {
    for (int i = -100; i <= 100; ++i) graph.keyframes[0].points.push_back(Eigen::Vector3d(0.01 * i * y, y, z_m - 0.6).cast<float>());
  }
  // A wall at y = 2 from x = -2 to 2 that was seen at these heights and is `top_m` high.
  void AddWall(const std::vector<double>& heights_m, double top_m) {
    MapSurface wall;
    wall.plane = {-Eigen::Vector3d::UnitY(), 2};
    wall.start = {2, 2};
    wall.end = {-2, 2};
    wall.z_max_m = top_m;
    wall.observations = {{0, {}}};
    for (int i = 0; i < 40; ++i) {
      for (const double z_m : heights_m) wall.cells.push_back(Eigen::Vector2d(0.1 * i + 0.05, z_m).cast<float>());
    }
    graph.surfaces.push_back(wall);
  }
  [[nodiscard]] CellState At(double x, double y) const {
    const FreeSpace space = FindFreeSpace(graph, floor, {});
    return space.cells[space.grid.CellAt({x, y})];
  }
};

TEST(FindFreeSpace, EndsAtAHitAndGoesOnNowhere) {
  Scene scene;
  scene.See(3, 0.8);
  EXPECT_EQ(scene.At(0, 1), CellState::kFree);
  EXPECT_EQ(scene.At(0, 2.9), CellState::kFree);
  EXPECT_EQ(scene.At(0, 3.01), CellState::kHit);
  EXPECT_EQ(scene.At(0, 3.15), CellState::kUnknown);
  EXPECT_EQ(scene.At(1.9, 0.05), CellState::kUnknown);
}

TEST(FindFreeSpace, SeesOverTablesButNotThroughTheCeiling) {
  Scene scene;
  scene.See(1.5, 0.7);  // a table's edge
  scene.See(4, 0.9);
  EXPECT_EQ(scene.At(0, 3), CellState::kFree);
  Scene high;
  high.See(4, 2.5);  // leaves the band at 4 * 1.3 / 1.9 = 2.74 m
  EXPECT_EQ(high.At(0, 2.6), CellState::kFree);
  EXPECT_EQ(high.At(0, 2.9), CellState::kUnknown);
}

TEST(FindFreeSpace, EndsAtAWallWithAWindow) {
  Scene scene;
  scene.See(2, 0.5);
  scene.See(6, 1.2);  // outside
  scene.AddWall({0.3, 0.6, 2.2}, 2.3);
  EXPECT_EQ(scene.At(0, 1.9), CellState::kFree);
  EXPECT_EQ(scene.At(0, 4), CellState::kUnknown);
}

TEST(FindFreeSpace, GoesOnThroughADoorBelowItsLintel) {
  Scene scene;
  scene.See(6, 1.2);
  scene.AddWall({2.2}, 2.3);
  EXPECT_EQ(scene.At(0, 4), CellState::kFree);
}

TEST(FindFreeSpace, GoesOnOverFurniture) {
  Scene scene;
  scene.See(2, 0.5);
  scene.See(6, 1.2);
  scene.AddWall({0.3, 0.6}, 0.8);
  EXPECT_EQ(scene.At(0, 4), CellState::kFree);
}

TEST(FindFreeSpace, KeepsItsGridWithinTheLimit) {
  Scene scene;
  scene.See(12, 0.8);
  RoomOptions options;
  options.max_cells = 1e4;
  const FreeSpace space = FindFreeSpace(scene.graph, scene.floor, options);
  EXPECT_LE(space.grid.size(), 10000u);
  EXPECT_DOUBLE_EQ(space.grid.cell_m, 0.2);
  EXPECT_EQ(space.cells[space.grid.CellAt({0, 6})], CellState::kFree);
}

TEST(FindFreeSpace, OfNoPointsHasNoCells) {
  const Scene scene;
  EXPECT_LT(FindFreeSpace(scene.graph, scene.floor, {}).grid.size(), 200u);  // about the sensor
  EXPECT_TRUE(FindFreeSpace({}, {}, {}).cells.empty());
}

}  // namespace
}  // namespace plumb::runtime
