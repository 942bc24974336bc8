#include "tools/simulate/as_built.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/support/house.h"

namespace plumb::tools {
namespace {

SimulateOptions Options(uint64_t seed, int deviate) {
  SimulateOptions options;
  options.seed = seed;
  options.deviate = deviate;
  return options;
}

TEST(DisplacementOf, IsMeasuredAtThePlannedMidpointAlongThePlannedNormal) {
  const AGraph house = test::MakeHouse();
  // Surface 1: the middle wall towards room A, from (4.94, 0) to (4.94, 3.44), normal -x.
  ASSERT_TRUE(house.surfaces[1].normal.isApprox(-Eigen::Vector3d::UnitX()));
  Eigen::Isometry2d shift = Eigen::Isometry2d::Identity();
  shift.translation() << 0.2, 0.1;
  EXPECT_NEAR(DisplacementOf(house, SurfaceId(1), shift).translation_m, -0.2, 1e-12);
  EXPECT_NEAR(DisplacementOf(house, SurfaceId(1), shift).rotation_rad, 0, 1e-12);
  // A turn about a point of the face 1 m north of the midpoint: the midpoint's line swings to +x by tan(0.1).
  const Eigen::Vector2d pivot(4.94, 1.72 + 1);
  const Eigen::Isometry2d turn = Eigen::Translation2d(pivot) * Eigen::Rotation2Dd(0.1) * Eigen::Translation2d(-pivot);
  const SurfaceDisplacement turned = DisplacementOf(house, SurfaceId(1), turn);
  EXPECT_NEAR(turned.translation_m, -std::tan(0.1), 1e-12);
  EXPECT_NEAR(turned.rotation_rad, 0.1, 1e-12);
}

TEST(BuildWithDeviations, TakesAShareOfTheWallsAsFarAsTheyCan) {
  const AGraph house = test::MakeHouse();
  SimulateOptions options = Options(1, 0);
  options.deviate_ratio = 0.01;
  EXPECT_EQ(BuildWithDeviations(house, StoreyId(0), options)->walls.size(), 1u) << "at least one";
  options.deviate_ratio = 1;
  const Expected<AsBuilt> all = BuildWithDeviations(house, StoreyId(0), options);
  ASSERT_TRUE(all) << all.error().message;
  EXPECT_EQ(all->walls.size(), 2u) << "one of three in each direction";
  EXPECT_FALSE(BuildWithDeviations(house, StoreyId(0), Options(1, 6))) << "a number is one";
}

TEST(BuildWithDeviations, KeepsWithinTheRangesAndAMajorityInPlace) {
  const AGraph house = test::MakeHouse();
  std::set<uint32_t> chosen;
  std::set<bool> signs;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const Expected<AsBuilt> built = BuildWithDeviations(house, StoreyId(0), Options(seed, 2));
    ASSERT_TRUE(built) << built.error().message;
    ASSERT_EQ(built->walls.size(), 2u);
    // Three walls in each direction: one of each may move.
    const auto axis = [&](size_t i) {
      const Wall& wall = house.walls[built->walls[i].wall.index()];
      return Eigen::Vector2d((wall.axis_end - wall.axis_start).normalized());
    };
    EXPECT_NEAR(axis(0).dot(axis(1)), 0, 1e-9);
    for (const WallDisplacement& w : built->walls) {
      chosen.insert(w.wall.value);
      signs.insert(w.translation_m > 0);
      EXPECT_GE(std::abs(w.translation_m), 0.05);
      EXPECT_LE(std::abs(w.translation_m), 0.35);
      EXPECT_LE(std::abs(w.rotation_rad), 0.0873);
      EXPECT_EQ(house.surfaces[w.reference.index()].wall, w.wall);
      EXPECT_TRUE(house.surfaces[w.reference.index()].room.valid());
      size_t faces = 0;
      for (const Surface& s : house.surfaces) faces += s.wall == w.wall ? 1 : 0;
      EXPECT_EQ(w.surfaces.size(), faces);
      for (const SurfaceDisplacement& s : w.surfaces) {
        if (s.surface == w.reference) {
          EXPECT_NEAR(s.translation_m, w.translation_m, 1e-9);
        }
      }
    }
  }
  EXPECT_GE(chosen.size(), 5u);
  EXPECT_EQ(signs.size(), 2u);
}

TEST(BuildWithDeviations, LeavesEveryRoomReachable) {
  const AGraph house = test::MakeHouse();
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const Expected<AsBuilt> built = BuildWithDeviations(house, StoreyId(0), Options(seed, 2));
    ASSERT_TRUE(built);
    const FreeSpace space(built->house, StoreyId(0), built->passages);
    EXPECT_EQ(FindReach(built->house, StoreyId(0), space).reachable(), 3u);
  }
}

TEST(BuildWithDeviations, RepeatsWithItsSeed) {
  const AGraph house = test::MakeHouse();
  const Expected<AsBuilt> a = BuildWithDeviations(house, StoreyId(0), Options(5, 2));
  const Expected<AsBuilt> b = BuildWithDeviations(house, StoreyId(0), Options(5, 2));
  const Expected<AsBuilt> c = BuildWithDeviations(house, StoreyId(0), Options(6, 2));
  ASSERT_TRUE(a && b && c);
  EXPECT_EQ(a->house.mesh.vertices, b->house.mesh.vertices);
  EXPECT_NE(a->house.mesh.vertices, c->house.mesh.vertices);
}

TEST(BuildWithDeviations, SaysSoWhenTooFewWallsCanMove) {
  const Expected<AsBuilt> built = BuildWithDeviations(test::MakeHouse(), StoreyId(0), Options(1, 3));
  ASSERT_FALSE(built);
  EXPECT_EQ(built.error().code, ErrorCode::kPlanUnsuitable);
  EXPECT_NE(built.error().message.find("2 of 3"), std::string::npos) << built.error().message;
}

TEST(BuildWithDeviations, LeavesTheHouseAloneWithoutDeviations) {
  const AGraph house = test::MakeHouse();
  const Expected<AsBuilt> built = BuildWithDeviations(house, StoreyId(0), Options(1, 0));
  ASSERT_TRUE(built);
  EXPECT_TRUE(built->walls.empty());
  EXPECT_EQ(built->house.mesh.vertices, house.mesh.vertices);
}

}  // namespace
}  // namespace plumb::tools
