#include "runtime/coupling/level_matching.h"

#include <gtest/gtest.h>

#include "schema/polygon.h"
#include "tests/support/house.h"
#include "tests/unit/runtime/coupling/scene.h"

namespace plumb::runtime {
namespace {

TEST(MatchLevels, FloorGoesToTheRoomItLiesIn) {
  const AGraph house = test::MakeHouse();
  EXPECT_TRUE(Contains(house.rooms[0], {1, 1}));
  EXPECT_FALSE(Contains(house.rooms[0], {6, 1}));
  Scene scene;
  MapSurface floor;
  floor.kind = SurfaceKind::kFloor;
  floor.plane.n = Eigen::Vector3d::UnitZ();
  Observation o;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(6, 1, 0.02), Eigen::Vector3d(7, 2, 0.02), Eigen::Vector3d(6.5, 3, 0.02)}) o.stats.Add(p);
  floor.observations.push_back(o);
  scene.map.surfaces.push_back(floor);
  MapSurface table = floor;
  table.observations[0].stats = o.stats.Transformed(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.75)));
  scene.map.surfaces.push_back(table);
  const auto matches = MatchSurfaces(scene.map, house, Eigen::Isometry3d::Identity(), {});
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].room, RoomId(2));
  EXPECT_NEAR(matches[0].offset_m, 0.02, 1e-9);
}

TEST(MatchLevels, TheBestSeenFloorIsWhereTheRobotStandsWhileTheHeightIsAGuess) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  const auto add = [&scene](double z_m, SurfaceKind kind, std::initializer_list<Eigen::Vector2d> places) {
    MapSurface level;
    level.kind = kind;
    level.plane.n = (kind == SurfaceKind::kFloor ? 1 : -1) * Eigen::Vector3d::UnitZ();
    level.observations.emplace_back();
    for (const Eigen::Vector2d& p : places) level.observations[0].stats.Add({p.x(), p.y(), z_m});
    scene.map.surfaces.push_back(level);
  };
  const double ceiling_m = house.rooms[2].ceiling_z_m;
  add(0.4, SurfaceKind::kFloor, {{6, 1}, {7, 2}, {6.5, 3}});
  add(1.1, SurfaceKind::kFloor, {{6, 1}, {6.2, 1.2}});  // a table
  add(ceiling_m + 0.41, SurfaceKind::kCeiling, {{6, 1}, {7, 2}, {6.5, 3}});
  const auto matches = MatchLevels(scene.map, house, Eigen::Isometry3d::Identity(), {});
  ASSERT_EQ(matches.size(), 2u);
  EXPECT_EQ(matches[0].map_surface, 0u);
  EXPECT_NEAR(matches[0].offset_m, 0.4, 1e-9);
  EXPECT_EQ(matches[1].map_surface, 2u);
  EXPECT_NEAR(matches[1].offset_m, 0.41, 1e-9);

  add(0.02, SurfaceKind::kFloor, {{6, 1}, {7, 2}});  // one floor where planned: the height is known, the others stand on it
  const auto known = MatchLevels(scene.map, house, Eigen::Isometry3d::Identity(), {});
  ASSERT_EQ(known.size(), 1u);
  EXPECT_EQ(known[0].map_surface, 3u);
}

// A map with levels in room 2 of the house, each of `points` points.
class Levels {
 public:
  void Add(double z_m, int points, SurfaceKind kind = SurfaceKind::kFloor) {
    MapSurface level;
    level.kind = kind;
    level.plane.n = (kind == SurfaceKind::kFloor ? 1 : -1) * Eigen::Vector3d::UnitZ();
    level.observations.emplace_back();
    for (int k = 0; k < points; ++k) level.observations[0].stats.Add({6 + 0.01 * (k % 100), 1 + 0.01 * (k / 100), z_m});
    scene_.map.surfaces.push_back(level);
  }
  // A view more of a level.
  void AddTo(size_t level, const Eigen::Vector3d& at, int points) {
    std::vector<Observation>& views = scene_.map.surfaces[level].observations;
    views.emplace_back();
    for (int k = 0; k < points; ++k) views.back().stats.Add(at + Eigen::Vector3d(0.001 * k, 0, 0));
  }
  [[nodiscard]] std::vector<uint32_t> Matched() const {
    std::vector<uint32_t> out;
    for (const Match& m : MatchLevels(scene_.map, test::MakeHouse(), Eigen::Isometry3d::Identity(), {})) out.push_back(m.map_surface);
    return out;
  }

 private:
  Scene scene_;
};

TEST(MatchLevels, ABenchTakenForTheFloorGivesWayToTheFloorBelowIt) {
  Levels levels;
  levels.Add(0.0, 300);  // the bench, where the plan has the floor: the place is 0.3 m too low
  EXPECT_EQ(levels.Matched(), std::vector<uint32_t>{0});
  levels.Add(-0.3, 50);
  EXPECT_EQ(levels.Matched(), std::vector<uint32_t>{0});  // not yet
  levels.Add(-0.31, 100);
  EXPECT_EQ(levels.Matched(), (std::vector<uint32_t>{1, 2}));
}

TEST(MatchLevels, NeitherTablesNorAFewReflectionsBelowTheFloorMoveIt) {
  Levels levels;
  levels.Add(0.02, 300);
  levels.Add(0.75, 900);  // tables, seen better than the floor under them
  levels.Add(-0.9, 80);   // a glossy floor
  EXPECT_EQ(levels.Matched(), std::vector<uint32_t>{0});
}

TEST(MatchLevels, ABenchIsNoFloorWhereTheFloorUnderItIsMatchedToTheNextRoom) {
  Levels levels;
  levels.Add(0.0, 100);
  levels.AddTo(0, {1, 1, 0}, 500);  // goes on into room 0, where more of it was seen
  levels.Add(0.22, 80);
  EXPECT_EQ(levels.Matched(), std::vector<uint32_t>{0});
}

// Its low end lies more than a step below its middle.
TEST(MatchLevels, ARampIsAFloor) {
  Levels levels;
  levels.Add(-0.25, 10);
  for (int k = 1; k <= 10; ++k) levels.AddTo(0, {6, 1, -0.25 + 0.05 * k}, 10);
  EXPECT_EQ(levels.Matched(), std::vector<uint32_t>{0});
}

// The room has a tenth of its floor's points in reflections, more than a third of what the small piece has.
TEST(MatchLevels, APieceOfTheFloorIsJudgedWithTheRest) {
  Levels levels;
  levels.Add(0.0, 800);
  levels.Add(0.01, 200);
  levels.Add(-0.9, 100);
  EXPECT_EQ(levels.Matched(), (std::vector<uint32_t>{0, 1}));
}

}  // namespace
}  // namespace plumb::runtime
