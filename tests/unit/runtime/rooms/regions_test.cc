#include "runtime/rooms/regions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "runtime/rooms/corridors.h"
#include "runtime/rooms/doorways.h"
#include "runtime/rooms/outline.h"

namespace plumb::runtime {
namespace {

using Box = Eigen::AlignedBox2d;
using Eigen::Vector2d;

Box Between(double x0, double y0, double x1, double y1) { return {Vector2d(x0, y0), Vector2d(x1, y1)}; }

// Free space drawn by hand: boxes of free cells, hits around them but for what lies in `unseen`.
FreeSpace Draw(const std::vector<Box>& free, const std::vector<WallPiece>& walls, const std::vector<Box>& unseen = {},
               const std::vector<Box>& blocked = {}) {
  FreeSpace space;
  space.walls = walls;
  Box all;
  for (const Box& box : free) all.extend(box);
  FloorGrid& grid = space.grid;
  grid.origin = all.min() - Vector2d(0.5, 0.5);
  grid.width = static_cast<int>(std::lround((all.sizes().x() + 1) / grid.cell_m));
  grid.height = static_cast<int>(std::lround((all.sizes().y() + 1) / grid.cell_m));
  const auto in = [](const std::vector<Box>& boxes, const Vector2d& p) {
    return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) { return box.contains(p); });
  };
  for (size_t i = 0; i < grid.size(); ++i) {
    const Vector2d p = grid.Center(i);
    const bool is_free = in(free, p) && !in(blocked, p);
    space.cells.push_back(is_free ? CellState::kFree : (in(unseen, p) ? CellState::kUnknown : CellState::kHit));
  }
  return space;
}

WallPiece Wall(uint32_t surface, double x0, double y0, double x1, double y1) { return {surface, {x0, y0}, {x1, y1}}; }

// The walls of a rectangle, seen from inside.
void AddWalls(const Box& room, uint32_t first, std::vector<WallPiece>* walls) {
  const Vector2d a = room.min(), b = room.max();
  walls->push_back(Wall(first, a.x(), a.y(), b.x(), a.y()));
  walls->push_back(Wall(first + 1, b.x(), a.y(), b.x(), b.y()));
  walls->push_back(Wall(first + 2, b.x(), b.y(), a.x(), b.y()));
  walls->push_back(Wall(first + 3, a.x(), b.y(), a.x(), a.y()));
}

TEST(FindRegions, LeavesAnLShapedRoomWhole) {
  const std::vector<WallPiece> walls = {Wall(0, 0, 0, 6, 0), Wall(1, 6, 0, 6, 3), Wall(2, 6, 3, 3, 3),
                                        Wall(3, 3, 3, 3, 6), Wall(4, 3, 6, 0, 6), Wall(5, 0, 6, 0, 0)};
  const FreeSpace space = Draw({Between(0, 0, 6, 3), Between(0, 3, 3, 6)}, walls);
  const Regions regions = FindRegions(space, {});
  ASSERT_EQ(regions.count, 1);
  EXPECT_TRUE(regions.necks.empty());
  const Outline outline = TraceOutlines(space, regions).front();
  EXPECT_EQ(outline.polygon.size(), 6u);
  EXPECT_NEAR(SignedArea(outline.polygon), 27, 0.01);
  EXPECT_EQ(outline.surfaces, (std::vector<uint32_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_GT(outline.covered_ratio, 0.98);
  EXPECT_EQ(outline.longest_unseen_m, 0);
  EXPECT_TRUE(outline.holes.empty());
}

TEST(FindRegions, PartsTwoRoomsAtADoor) {
  std::vector<WallPiece> walls;
  AddWalls(Between(0, 0, 4, 4), 0, &walls);
  AddWalls(Between(4.2, 0, 8, 4), 10, &walls);
  walls[1] = Wall(1, 4, 0, 4, 1);  // beside the door
  walls.push_back(Wall(1, 4, 1.9, 4, 4));
  walls[7] = Wall(13, 4.2, 4, 4.2, 1.9);
  walls.push_back(Wall(13, 4.2, 1, 4.2, 0));
  const FreeSpace space = Draw({Between(0, 0, 4, 4), Between(4.2, 0, 8, 4), Between(3.9, 1, 4.3, 1.9)}, walls);
  const Regions regions = FindRegions(space, {});
  ASSERT_EQ(regions.count, 2);
  ASSERT_EQ(regions.necks.size(), 1u);
  const auto opening = MeasureOpening(space, regions, regions.necks.front(), {});
  ASSERT_TRUE(opening);
  EXPECT_NEAR(opening->position.x(), 4.1, 0.02);
  EXPECT_NEAR(opening->position.y(), 1.45, 0.02);
  EXPECT_NEAR(opening->width_m, 0.9, 0.03);
  EXPECT_NEAR(opening->yaw_rad, 0, 0.01);
  const std::vector<Outline> outlines = TraceOutlines(space, regions);
  EXPECT_NEAR(SignedArea(outlines[0].polygon), 16, 0.4);
  EXPECT_NEAR(SignedArea(outlines[1].polygon), 15.2, 0.4);
}

TEST(FindRegions, MeasuresADoorWithoutWallsBesideIt) {
  const FreeSpace space = Draw({Between(0, 0, 4, 4), Between(4.2, 0, 8, 4), Between(3.9, 1, 4.3, 1.9)}, {});
  const Regions regions = FindRegions(space, {});
  ASSERT_EQ(regions.necks.size(), 1u);
  const auto opening = MeasureOpening(space, regions, regions.necks.front(), {});
  ASSERT_TRUE(opening);
  EXPECT_NEAR((opening->position - Vector2d(4.1, 1.45)).norm(), 0, 0.06);
  EXPECT_NEAR(opening->width_m, 0.9, 0.08);
}

TEST(FindRegions, LeavesAnOpenPlanWhole) {
  const FreeSpace space = Draw({Between(0, 0, 5, 5), Between(5.2, 0, 10, 5), Between(4.9, 0.5, 5.3, 4)}, {});
  EXPECT_EQ(FindRegions(space, {}).count, 1);
}

TEST(FindRegions, PartsAWidePassageOnlyWhereItIsInAWall) {
  const std::vector<Box> free = {Between(0, 0, 5, 5), Between(5.2, 0, 10, 5), Between(4.9, 1.5, 5.3, 3.4)};
  EXPECT_EQ(FindRegions(Draw(free, {}), {}).count, 1);
  const std::vector<WallPiece> walls = {Wall(0, 5, 0, 5, 1.5), Wall(0, 5, 3.4, 5, 5), Wall(1, 5.2, 5, 5.2, 3.4), Wall(1, 5.2, 1.5, 5.2, 0)};
  EXPECT_EQ(FindRegions(Draw(free, walls), {}).count, 2);
}

TEST(FindRegions, PartsACorridorHardlyWiderThanItsDoor) {
  const std::vector<Box> free = {Between(0, 0, 4, 4), Between(0, -1.2, 8, -0.2), Between(1.5, -0.3, 2.4, 0.1)};
  const std::vector<WallPiece> walls = {Wall(0, 0, 0, 1.5, 0), Wall(0, 2.4, 0, 4, 0), Wall(1, 8, -0.2, 2.4, -0.2),
                                        Wall(1, 1.5, -0.2, 0, -0.2), Wall(2, 0, -1.2, 8, -1.2)};
  EXPECT_EQ(FindRegions(Draw(free, walls), {}).count, 2);
}

TEST(FindRegions, KeepsARoomWithAPillarAsOneWithAHole) {
  const FreeSpace space = Draw({Between(0, 0, 8, 8)}, {}, {}, {Between(3.7, 3.7, 4.3, 4.3)});
  const Regions regions = FindRegions(space, {});
  ASSERT_EQ(regions.count, 1);
  const Outline outline = TraceOutlines(space, regions).front();
  ASSERT_EQ(outline.holes.size(), 1u);
  EXPECT_NEAR(SignedArea(outline.holes[0]), -0.36, 0.02);
  EXPECT_NEAR(SignedArea(outline.polygon), 64, 0.01);
}

TEST(FindRegions, IsNoRoomWhereLightConesMeet) {
  // Looked into through two doors: the cones are parted by what nobody has seen.
  const std::vector<Box> unseen = {Between(-1, -1, 9, 9)};
  EXPECT_EQ(FindRegions(Draw({Between(0, 0, 3, 3), Between(3.5, 0, 6.5, 3), Between(2.9, 1, 3.6, 1.9)}, {}, unseen), {}).count, 1);
}

TEST(FindRegions, GivesNichesToTheRoomTheyOpenInto) {
  const FreeSpace space = Draw({Between(0, 0, 4, 4), Between(4.1, 1, 5.1, 2), Between(3.9, 1.2, 4.2, 1.8)}, {});
  EXPECT_EQ(FindRegions(space, {}).count, 1);  // 1 m2
}

TEST(FindRegions, OfNothingIsNothing) {
  const Regions regions = FindRegions({}, {});
  EXPECT_EQ(regions.count, 0);
  EXPECT_TRUE(TraceOutlines({}, regions).empty());
}

TEST(FindCorridors, FindsTheWallsOfACorridorWithoutEnds) {
  const std::vector<WallPiece> walls = {Wall(3, 0, 0, 12, 0), Wall(7, 12, 2, 0, 2)};
  const FreeSpace space = Draw({Between(0, 0, 12, 2)}, walls, {Between(-1, 0, 0, 2), Between(12, 0, 13, 2)});
  const Regions regions = FindRegions(space, {});
  ASSERT_EQ(regions.count, 1);
  const Outline outline = TraceOutlines(space, regions).front();
  EXPECT_NEAR(outline.longest_unseen_m, 2, 0.15);
  const std::vector<MapCorridor> corridors = FindCorridors(space, regions, 0, outline);
  ASSERT_EQ(corridors.size(), 1u);
  EXPECT_EQ(corridors[0].surface_a, 3u);
  EXPECT_EQ(corridors[0].surface_b, 7u);
  EXPECT_NEAR(corridors[0].width_m, 2, 1e-9);
  EXPECT_NEAR(corridors[0].start.y(), 1, 1e-9);
  EXPECT_NEAR((corridors[0].end - corridors[0].start).norm(), 12, 0.2);
}

TEST(TraceOutlines, SaysHowMuchOfARoomSeenInPartIsUnseen) {
  const std::vector<WallPiece> walls = {Wall(0, 0, 0, 5, 0), Wall(1, 0, 4, 0, 0)};
  const FreeSpace space = Draw({Between(0, 0, 5, 4)}, walls, {Between(5, 0, 6, 5), Between(0, 4, 6, 5)});
  const Outline outline = TraceOutlines(space, FindRegions(space, {})).front();
  EXPECT_NEAR(outline.covered_ratio, 0.5, 0.03);
  EXPECT_GT(outline.longest_unseen_m, 3.9);
}

TEST(TraceOutlines, PutsSlantedWallsOnTheirLines) {
  // A square turned by 30 degrees.
  const Eigen::Rotation2Dd turn(std::numbers::pi / 6);
  std::vector<Vector2d> corners = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  for (Vector2d& corner : corners) corner = turn * corner;
  std::vector<WallPiece> walls;
  for (uint32_t i = 0; i < 4; ++i) walls.push_back({i, corners[i], corners[(i + 1) % 4]});
  FreeSpace space = Draw({Between(-3, -1, 5, 6)}, walls);
  for (size_t i = 0; i < space.cells.size(); ++i) {
    const Vector2d p = turn.inverse() * space.grid.Center(i);
    if (p.minCoeff() < 0 || p.maxCoeff() > 4) space.cells[i] = CellState::kHit;
  }
  const Outline outline = TraceOutlines(space, FindRegions(space, {})).front();
  ASSERT_EQ(outline.polygon.size(), 4u);
  EXPECT_NEAR(SignedArea(outline.polygon), 16, 1e-6);
  EXPECT_NEAR((AreaCentroid(outline.polygon) - turn * Vector2d(2, 2)).norm(), 0, 1e-6);
}

}  // namespace
}  // namespace plumb::runtime
