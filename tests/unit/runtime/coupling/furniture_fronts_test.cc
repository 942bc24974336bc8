#include "runtime/coupling/furniture_fronts.h"

#include <gtest/gtest.h>

#include "tests/support/house.h"
#include "tests/unit/runtime/coupling/scene.h"

namespace plumb::runtime {
namespace {

// On a planar laser's line, a row of cupboards is as long and as straight as the wall behind it.
TEST(MatchSurfaces, TakesNoFurnitureFrontOfAPlanarScanForAWallSeenFromBehind) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  scene.map.planar = true;
  const uint32_t front = scene.Add({4.79, 0.5}, {4.79, 3.0});  // 15 cm before A's east wall
  EXPECT_EQ(scene.Of(house, front), SurfaceId(1));             // nothing says that the wall is not there
  const uint32_t other_face = scene.Add({5.06, 5.0}, {5.06, 1.0});
  EXPECT_FALSE(scene.Of(house, front).valid());
  EXPECT_EQ(scene.Of(house, other_face), SurfaceId(11));

  Scene moved;  // both faces alike: the wall stands elsewhere
  moved.map.planar = true;
  const uint32_t in_a = moved.Add({4.79, 0.5}, {4.79, 3.0}), in_c = moved.Add({4.91, 5.0}, {4.91, 1.0});
  EXPECT_EQ(moved.Of(house, in_a), SurfaceId(1));
  EXPECT_EQ(moved.Of(house, in_c), SurfaceId(11));
}

// Units along the other side of a wall whose face is seen would make it 0.3 m thick; so would one seen higher up than the wall's own piece.
TEST(MatchSurfaces, AFrontThatMakesAWallTooThickIsFurniture) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  const uint32_t in_a = scene.Add({4.94, 0.5}, {4.94, 3.0}, 0.1, 2.2), front = scene.Add({5.26, 5.0}, {5.26, 1.0}, 0.1, 1.0);
  EXPECT_EQ(scene.Of(house, in_a), SurfaceId(1));
  EXPECT_FALSE(scene.Of(house, front).valid());

  Scene moved;  // the wall stands 0.2 m further in A, and what is seen in C reaches as high as it does
  const uint32_t far_in_a = moved.Add({4.74, 0.5}, {4.74, 3.0}, 0.1, 2.2), in_c = moved.Add({4.86, 5.0}, {4.86, 1.0}, 0.1, 2.2);
  EXPECT_EQ(moved.Of(house, far_in_a), SurfaceId(1));
  EXPECT_EQ(moved.Of(house, in_c), SurfaceId(11));

  Scene hidden;  // the same, behind units that stand where C has its face
  const uint32_t higher = hidden.Add({4.74, 0.5}, {4.74, 3.0}, 0.1, 2.2), units = hidden.Add({5.06, 5.0}, {5.06, 1.0}, 0.1, 1.0);
  EXPECT_EQ(hidden.Of(house, higher), SurfaceId(1));
  EXPECT_FALSE(hidden.Of(house, units).valid());
}

// Parallel walls, 20 m long and 0.2 m thick, both sides of each matched to what was seen of it: from the north to 2.4 m up, from the south
// to 2.0 m.
struct Row {
  AGraph plan;
  std::vector<Patch> patches;
  std::vector<Match> matches;

  // `thicker_m`: of the wall as seen. North is seen from `from_m` on, south up to `to_m`, and each leans by `lean_rad` towards the other.
  void Add(double thicker_m, double from_m = 0, double to_m = 20, double lean_rad = 0) {
    const double y = 3.0 * static_cast<double>(plan.walls.size()), half_m = 0.1 + 0.5 * thicker_m;
    Wall wall;
    wall.thickness_m = 0.2;
    wall.axis_start = {0, y};
    wall.axis_end = {20, y};
    plan.walls.push_back(wall);
    Face({20, y + 0.1}, {0, y + 0.1}, Eigen::Vector2d(20, y + half_m), {from_m, y + half_m - lean_rad * (20 - from_m)}, 2.4);
    Face({0, y - 0.1}, {20, y - 0.1}, Eigen::Vector2d(0, y - half_m), {to_m, y - half_m + lean_rad * to_m}, 2.0);
  }
  void Face(const Eigen::Vector2d& start, const Eigen::Vector2d& end, const Eigen::Vector2d& seen_start, const Eigen::Vector2d& seen_end,
            double z_max_m) {
    Surface s;
    s.wall = WallId(plan.walls.size() - 1);
    s.start = start;
    s.end = end;
    const double north = start.x() > end.x() ? 1 : -1;
    s.normal = {0, north, 0};
    s.z_max_m = 2.5;
    const Eigen::Vector2d along = (seen_end - seen_start).normalized();
    const auto id = static_cast<uint32_t>(plan.surfaces.size());
    plan.surfaces.push_back(s);
    patches.push_back(
        {id, 3, seen_start, seen_end, {along.y(), -along.x(), 0}, 0, z_max_m, 0, (seen_end - seen_start).norm() * z_max_m, nullptr});
    matches.push_back({id, SurfaceId(id), RoomId(), 0, 0, {}});
  }
  // Those of the map surfaces that are left.
  [[nodiscard]] std::vector<uint32_t> Left() const {
    std::vector<Match> left = matches;
    DropLowFronts(plan, WallFrames(plan), patches, left);
    std::vector<uint32_t> out;
    for (const Match& m : left) out.push_back(m.map_surface);
    return out;
  }
};

TEST(DropLowFronts, WhatAllWallsAreThickerByIsTheLidarsBias) {
  Row row;
  for (int k = 0; k < 4; ++k) row.Add(0.05);
  EXPECT_EQ(row.Left().size(), 8u);
  row.Add(0.12);  // units along its south side
  EXPECT_EQ(row.Left(), (std::vector<uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

// Led on to the middle between them, the lines of both would be 16 cm further apart than the wall is thick.
TEST(DropLowFronts, FacesSeenAtOppositeEndsOfAWallSayNothingOfItsThickness) {
  Row row;
  row.Add(0, 17, 3, -0.008);
  EXPECT_EQ(row.Left().size(), 2u);
}

}  // namespace
}  // namespace plumb::runtime
