#include "runtime/coupling/coupling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <tuple>

#include "runtime/coupling/wall_frame.h"
#include "tests/support/house.h"
#include "tests/support/synthetic_sgraph.h"
#include "tests/unit/runtime/coupling/scene.h"

namespace plumb::runtime {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

// House surfaces: A 0..3, B 4..7, C 8..11 in the order south, east, north, west.
TEST(MatchSurfaces, FindsEverySurfaceOfADrive) {
  const AGraph house = test::MakeHouse();
  const test::Drive drive = test::DriveThroughHouse(house);
  const auto matches = MatchSurfaces(drive.map, house, test::Disturbed(drive.T_plan_map, 0.1, -0.1, 1 * kDeg), {});
  EXPECT_EQ(matches.size(), drive.map.surfaces.size());
  for (const Match& m : matches) {
    EXPECT_EQ(m.plan_surface, drive.built[m.map_surface]);
    EXPECT_EQ(m.room.valid(), drive.map.surfaces[m.map_surface].kind != SurfaceKind::kWall);
  }
}

TEST(MatchSurfaces, MeasuresOffsetAlongTheNormalAndYawCounterClockwise) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  scene.Add({9 - 0.2, 1}, {9 - 0.2, 5});  // C's east wall (normal -x), 0.2 m into the room
  const auto matches = MatchSurfaces(scene.map, house, Eigen::Isometry3d::Identity(), {});
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].plan_surface, SurfaceId(9));
  EXPECT_NEAR(matches[0].offset_m, 0.2, 1e-9);
  EXPECT_NEAR(matches[0].yaw_rad, 0, 1e-9);

  Scene turned;
  const Eigen::Vector2d half = Eigen::Rotation2Dd(5 * kDeg) * Eigen::Vector2d(0, 2);
  turned.Add(Eigen::Vector2d(9, 3) - half, Eigen::Vector2d(9, 3) + half);
  EXPECT_NEAR(MatchSurfaces(turned.map, house, Eigen::Isometry3d::Identity(), {}).at(0).yaw_rad, 5 * kDeg, 1e-9);
}

// A closed door in the middle of its wall is as large as many a wall patch, and 5 to 15 cm off the wall's face.
TEST(MatchSurfaces, TakesNoLeafInADoorwayForTheWall) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  const uint32_t leaf = scene.Add({-0.15, 2.1}, {-0.15, 1.2}, 0.0, 2.0);        // in D3, A's west wall
  const uint32_t with_frame = scene.Add({-0.06, 2.5}, {-0.06, 1.2}, 0.0, 2.2);  // grown together with a bit of wall
  const uint32_t wall = scene.Add({0, 3.4}, {0, 2.2});
  EXPECT_FALSE(scene.Of(house, leaf).valid());
  EXPECT_FALSE(scene.Of(house, with_frame).valid());
  EXPECT_EQ(scene.Of(house, wall), SurfaceId(3));

  Scene displaced;  // the same wall 0.15 m further out, seen beside the door
  const uint32_t moved = displaced.Add({-0.15, 3.4}, {-0.15, 2.2});
  EXPECT_EQ(displaced.Of(house, moved), SurfaceId(3));
}

TEST(MatchSurfaces, NeverMatchesTheOtherFaceOfAWall) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  const uint32_t in_c = scene.Add({5.06, 5.0}, {5.06, 1.0});  // normal +x: C's west
  const uint32_t in_a = scene.Add({4.94, 0.5}, {4.94, 3.0});  // normal -x: A's east
  EXPECT_EQ(scene.Of(house, in_c), SurfaceId(11));
  EXPECT_EQ(scene.Of(house, in_a), SurfaceId(1));
}

TEST(MatchSurfaces, RespectsGatesOfOverlapHeightAndDistance) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  EXPECT_FALSE(scene.Of(house, scene.Add({8.2, 1}, {8.2, 5})).valid());            // 0.8 m off
  EXPECT_FALSE(scene.Of(house, scene.Add({9.0, 6.5}, {9.0, 8.0})).valid());        // beyond the wall's end
  EXPECT_FALSE(scene.Of(house, scene.Add({9.0, 1}, {9.0, 5}, 2.7, 5.0)).valid());  // a storey higher
  EXPECT_TRUE(scene.Of(house, scene.Add({9.0, 1}, {9.0, 5})).valid());
}

TEST(MatchSurfaces, KnownDeviationKeepsAPatchThatIsFarFromThePlan) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  const uint32_t patch = scene.Add({9 - 0.7, 1}, {9 - 0.7, 5});
  EXPECT_FALSE(scene.Of(house, patch).valid());
  std::vector<WallDeviation> known(house.walls.size());
  known[1] = {house.surfaces[WallFrames(house)[1].reference.index()].normal.x() < 0 ? 0.65 : -0.65, 0};
  EXPECT_EQ(scene.Of(house, patch, known), SurfaceId(9));
}

TEST(MatchSurfaces, WallBehindACupboardIsTheWall) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  const uint32_t wall_a = scene.Add({9, 0.3}, {9, 1.5}), front = scene.Add({8.5, 1.5}, {8.5, 4}, 0.2, 1.8),
                 wall_b = scene.Add({9, 4}, {9, 5.7});
  EXPECT_EQ(scene.Of(house, wall_a), SurfaceId(9));
  EXPECT_EQ(scene.Of(house, wall_b), SurfaceId(9));
  EXPECT_FALSE(scene.Of(house, front).valid());
}

// The wall was built 0.3 m further out, and a cupboard stands where the plan has the wall.
TEST(MatchSurfaces, WallBehindWinsEvenIfTheCupboardStandsOnThePlannedLine) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  const uint32_t wall = scene.Add({9.3, 0.3}, {9.3, 2.5}, 0.2, 2.5), front = scene.Add({9, 2.5}, {9, 5.5}, 0.2, 1.8);
  EXPECT_EQ(scene.Of(house, wall), SurfaceId(9));
  EXPECT_FALSE(scene.Of(house, front).valid());
}

// The front of low units as long as the wall, of which nothing but single points is seen above them.
TEST(MatchSurfaces, WhatIsSeenPastIsNoWall) {
  const AGraph house = test::MakeHouse();
  const Eigen::Vector3d sensor(7, 3, 1);
  Scene units;
  const uint32_t front = units.Add({8.55, 0.2}, {8.55, 5.8}, 0.1, 1.4);
  EXPECT_EQ(units.Of(house, front), SurfaceId(9));  // nothing speaks against it yet
  units.See(sensor, {8.55, 0.2}, {8.55, 5.8}, 0.1, 1.4);
  EXPECT_EQ(units.Of(house, front), SurfaceId(9));
  units.See(sensor, {9, 0.2}, {9, 5.8}, 1.6, 2.4);
  EXPECT_FALSE(units.Of(house, front).valid());

  Scene deviated;  // the same front as high as the room, and a view into the next room through an opening beside it
  const uint32_t wall = deviated.Add({8.55, 0.2}, {8.55, 5.8}, 0.1, 2.4);
  deviated.See(sensor, {8.55, 0.2}, {8.55, 5.8}, 0.1, 2.4);
  deviated.See(sensor, {9.5, 8}, {9.5, 9.5}, 0.1, 2.4);
  EXPECT_EQ(deviated.Of(house, wall), SurfaceId(9));
}

TEST(MatchSurfaces, PanesJoinedAcrossAStripOfWallAreNoWall) {
  AGraph house = test::MakeHouse();
  for (double y_m : {1.6, 4.2}) {  // in C's east wall
    Window w;
    w.wall = WallId(1);
    w.position = {9.15, y_m, 0.9};
    w.width_m = w.height_m = 1.2;
    house.windows.push_back(w);
  }
  Scene scene;
  const uint32_t panes = scene.Add({9.1, 1.0}, {9.1, 4.8}, 0.9, 2.1);
  EXPECT_FALSE(scene.Of(house, panes).valid());
  Scene displaced;  // the whole wall 0.1 m further out
  const uint32_t wall = displaced.Add({9.1, 0.2}, {9.1, 5.8}, 0.2, 2.4);
  EXPECT_EQ(displaced.Of(house, wall), SurfaceId(9));
}

// A pane that the map has joined to the wall far beside it, because a plane can lean across both.
TEST(MatchSurfaces, ViewsOfAPaneInAPatchOfWallAreMistaken) {
  AGraph house = test::MakeHouse();
  Window w;  // in C's east wall
  w.wall = WallId(1);
  w.position = {9.15, 1.2, 0.4};
  w.width_m = 1.2;
  w.height_m = 2.0;
  house.windows.push_back(w);
  Scene scene;
  const uint32_t patch = scene.Add({9.05, 0.6}, {8.98, 5.8}, 0.4, 2.4);  // its own view is centred beside the window
  Observation pane;
  for (double y_m : {0.8, 1.6}) {
    for (double z_m : {0.6, 2.0}) pane.stats.Add({9.1, y_m, z_m});
  }
  scene.map.surfaces[patch].observations.push_back(pane);
  const auto matches = MatchSurfaces(scene.map, house, Eigen::Isometry3d::Identity(), {});
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].plan_surface, SurfaceId(9));
  EXPECT_FALSE(matches[0].IsMistaken(0));
  EXPECT_TRUE(matches[0].IsMistaken(1));
  scene.map.surfaces[patch].observations.erase(scene.map.surfaces[patch].observations.begin());
  EXPECT_FALSE(scene.Of(house, patch).valid());  // nothing of the wall is left
}

TEST(MatchSurfaces, SmallLowNicheBehindAWallIsNotTheWall) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  const uint32_t wall = scene.Add({9, 0.3}, {9, 5.7}, 0.2, 2.3), niche = scene.Add({9.25, 2.0}, {9.25, 3.2}, 0.2, 0.9);
  EXPECT_EQ(scene.Of(house, wall), SurfaceId(9));
  EXPECT_FALSE(scene.Of(house, niche).valid());
}

// Two plan faces 0.3 m apart, both built 0.2 m further: each patch alone would prefer the wrong one.
TEST(MatchSurfaces, CompetingFacesAreDecidedTogether) {
  AGraph plan = test::MakeHouse();
  Wall extra = plan.walls[1];
  extra.guid = "wall-extra";
  plan.walls.push_back(extra);
  Surface face = plan.surfaces[9];  // C's east
  face.wall = WallId(plan.walls.size() - 1);
  face.start.x() -= 0.3;
  face.end.x() -= 0.3;
  face.d_m -= 0.3;
  plan.surfaces.push_back(face);
  Scene scene;
  const uint32_t outer = scene.Add({8.8, 0.5}, {8.8, 5.5}), inner = scene.Add({8.5, 0.5}, {8.5, 5.5});
  EXPECT_EQ(scene.Of(plan, outer), SurfaceId(9));
  EXPECT_EQ(scene.Of(plan, inner), SurfaceId(plan.surfaces.size() - 1));
}

TEST(MatchSurfaces, PatchesOfATurnedWallStayTogether) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  const auto at = [](double y) { return Eigen::Vector2d(9 - std::tan(5 * kDeg) * (y - 3), y); };
  const uint32_t a = scene.Add(at(0.3), at(2)), b = scene.Add(at(2.5), at(4)), c = scene.Add(at(4.3), at(5.8));
  for (uint32_t patch : {a, b, c}) EXPECT_EQ(scene.Of(house, patch), SurfaceId(9));
}

TEST(MatchSurfaces, FindsAWallFarOffWhereItsPlannedPlaceIsSeenThrough) {
  const AGraph house = test::MakeHouse();
  for (const double yaw_deg : {0.0, 27.0}) {
    const auto at = [&](double y) { return Eigen::Vector2d(yaw_deg == 0 ? 9.58 : 9.3 - std::tan(yaw_deg * kDeg) * (y - 3), y); };
    const Eigen::Vector2d start = at(yaw_deg == 0 ? 0.2 : 1.6), end = at(yaw_deg == 0 ? 5.8 : 4.4);
    Scene scene;
    const uint32_t patch = scene.Add(start, end, 0.1, 2.5);
    scene.map.surfaces[patch].observations.push_back(scene.map.surfaces[patch].observations.front());
    EXPECT_FALSE(scene.Of(house, patch).valid()) << "nothing proves that the wall is not where planned";
    scene.See({6, 3, 0.6}, start, end, 0.1, 2.5);
    scene.See({6.5, 2, 0.6}, start, end, 0.1, 2.5);
    EXPECT_EQ(scene.Of(house, patch), SurfaceId(9)) << yaw_deg << " deg";
  }
}

// The south wall passes two rooms: turned about a place in either, it stands metres off elsewhere, at its middle or where it is seen.
TEST(MatchSurfaces, FindsAWallFarTurnedAboutAnyPlaceInIt) {
  const AGraph house = test::MakeHouse();
  for (const auto& [about_x, turn_deg] : {std::pair{7.5, 27.0}, std::pair{0.5, -9.0}}) {
    const auto at = [x0 = about_x, slope = std::tan(turn_deg * kDeg)](double x) { return Eigen::Vector2d(x, slope * (x - x0)); };
    Scene scene;
    const uint32_t patch = scene.Add(at(5.6), at(8.4), 0.1, 2.5);
    scene.map.surfaces[patch].observations.push_back(scene.map.surfaces[patch].observations.front());
    scene.See({7, 3, 0.6}, at(5.6), at(8.4), 0.1, 2.5);
    scene.See({6.5, 4, 0.6}, at(5.6), at(8.4), 0.1, 2.5);
    const SurfaceId found = scene.Of(house, patch);
    ASSERT_TRUE(found.valid()) << about_x;
    EXPECT_EQ(house.walls[house.surfaces[found.index()].wall.index()].guid, "wall-south");
    EXPECT_GT(house.surfaces[found.index()].midpoint().x(), 5);
  }
}

// Each of the faces that rooms divide its side into was met by too few lines to tell alone.
TEST(MatchSurfaces, FindsAWallFarOffByWhatIsSeenOfAllItsFaces) {
  const AGraph whole = test::MakeHouse();
  AGraph parted = whole;
  parted.surfaces[9].end = whole.surfaces[9].midpoint();
  parted.surfaces.push_back(whole.surfaces[9]);
  parted.surfaces.back().start = whole.surfaces[9].midpoint();
  Scene scene;
  const Eigen::Vector2d start(9.58, 1.2), end(9.58, 4.8);
  const uint32_t patch = scene.Add(start, end, 0.1, 2.5);
  scene.map.surfaces[patch].observations.push_back(scene.map.surfaces[patch].observations.front());
  scene.See({6, 3, 0.6}, start, end, 0.5, 0.7);
  const auto wall_of = [&](const AGraph& plan) {
    const SurfaceId found = scene.Of(plan, patch);
    return found.valid() ? plan.surfaces[found.index()].wall : WallId();
  };
  EXPECT_EQ(wall_of(whole), whole.surfaces[9].wall);
  EXPECT_EQ(wall_of(parted), whole.surfaces[9].wall);
}

// The wall's other face stands as planned beyond the end of what is seen, nearer to it than the margin about faces.
TEST(MatchSurfaces, FindsAWallFarOffWhateverIsSeenBesideIt) {
  const AGraph whole = test::MakeHouse();
  AGraph parted = whole;
  const Eigen::Vector2d cut =
      whole.surfaces[9].start + 4.9 / whole.surfaces[9].length_m() * (whole.surfaces[9].end - whole.surfaces[9].start);
  const bool forth = whole.surfaces[9].end.y() > whole.surfaces[9].start.y();
  ASSERT_TRUE(forth);
  parted.surfaces[9].end = cut;
  parted.surfaces.push_back(whole.surfaces[9]);
  parted.surfaces.back().start = cut;
  Scene scene;
  const Eigen::Vector2d start(9.58, 1.2), end(9.58, 4.8);
  const uint32_t patch = scene.Add(start, end, 0.1, 2.5);
  scene.map.surfaces[patch].observations.push_back(scene.map.surfaces[patch].observations.front());
  scene.See({6, 3, 0.6}, start, end, 0.1, 2.5);
  for (int i = 0; i < 5; ++i) scene.See({6, 5.4, 0.6}, {9, 5.15}, {9, 5.75}, 0.4, 2.2);
  EXPECT_EQ(scene.Of(parted, patch), SurfaceId(9));
}

// A parapet is seen through a pane, higher and farther off.
TEST(MatchSurfaces, APaneIsTheWallWhereItIsPlannedOfGlass) {
  AGraph house = test::MakeHouse();
  Scene scene;
  const uint32_t pane = scene.Add({9, 0.5}, {9, 5.5}, 0.2, 1.2), parapet = scene.Add({9.24, 0.5}, {9.24, 5.5}, 0.2, 2.4);
  EXPECT_EQ(scene.Of(house, parapet), SurfaceId(9));
  EXPECT_FALSE(scene.Of(house, pane).valid());
  for (Element& e : house.elements) {
    if (e.wall == house.surfaces[9].wall) e.material = Material::kGlass;
  }
  EXPECT_EQ(scene.Of(house, pane), SurfaceId(9));
  EXPECT_FALSE(scene.Of(house, parapet).valid());
}

TEST(MatchSurfaces, FindsNoWallFarOffWhereTwoStandForIt) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  const uint32_t nearer = scene.Add({9.54, 0.2}, {9.54, 2.7}, 0.1, 2.5), farther = scene.Add({9.62, 3.0}, {9.10, 4.0}, 0.1, 2.5);
  for (const uint32_t patch : {nearer, farther}) {
    MapSurface& s = scene.map.surfaces[patch];
    s.observations.push_back(s.observations.front());
    scene.See({6, 3, 0.6}, s.start, s.end, 0.1, 2.5);
  }
  EXPECT_TRUE(scene.Of(house, nearer).valid());  // as it is the longer
  EXPECT_FALSE(scene.Of(house, farther).valid());
}

TEST(MatchSurfaces, PiecesThatAreTurnedAgainstTheWallAreNotOfIt) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  const uint32_t wall = scene.Add({9, 1.2}, {9, 3.5});
  const Eigen::Vector2d turned(-std::sin(14 * kDeg), std::cos(14 * kDeg));
  const Eigen::Vector2d middle(9, 4.5);
  const uint32_t box = scene.Add(middle - 0.45 * turned, middle + 0.45 * turned, 0.2, 1.2);
  EXPECT_EQ(scene.Of(house, wall), SurfaceId(9));
  EXPECT_FALSE(scene.Of(house, box).valid());
}

TEST(MatchSurfaces, ASkirtingIsNotTheWallBehindIt) {
  AGraph house = test::MakeHouse();
  house.surfaces[9].z_max_m = 0.25;
  Scene behind, on;
  const uint32_t far = behind.Add({9.1, 1}, {9.1, 5}, 0.0, 2.5), near = on.Add({9, 1}, {9, 5}, 0.0, 2.5);
  EXPECT_FALSE(behind.Of(house, far).valid());
  EXPECT_EQ(on.Of(house, near), SurfaceId(9));
}

TEST(MatchSurfaces, AWallThatRoomsDivideIntoManyFacesIsOneWhenItIsOff) {
  AGraph house = test::MakeHouse();
  const Surface whole = house.surfaces[9];
  const WallId wall = whole.wall;
  const Eigen::Vector2d part = 0.25 * (whole.end - whole.start);
  house.surfaces[9].end = whole.start + part;
  for (int k = 1; k < 4; ++k) {
    house.surfaces.push_back(whole);
    house.surfaces.back().start = whole.start + k * part;
    house.surfaces.back().end = house.surfaces.back().start + part;
  }
  Scene scene;
  const uint32_t patch = scene.Add({8.8, whole.start.y()}, {8.8, whole.end.y()}, 0.0, 2.5);
  const SurfaceId found = scene.Of(house, patch);
  ASSERT_TRUE(found.valid());
  EXPECT_EQ(house.surfaces[found.index()].wall, wall);
}

TEST(MatchSurfaces, AWallIsThatOfTheStoreySeenNotTheOneAboveInTheSamePlane) {
  AGraph house = test::MakeHouse();
  house.walls.push_back(house.walls[house.surfaces[9].wall.index()]);
  Surface above = house.surfaces[9];  // the storey above, seen through a stair hall, with no wall between its rooms
  above.wall = WallId(house.walls.size() - 1);
  above.z_min_m = above.z_max_m;
  above.z_max_m += 0.7;
  const Eigen::Vector2d half = 0.5 * (house.surfaces[9].start + house.surfaces[9].end);
  house.surfaces.push_back(house.surfaces[9]);
  house.surfaces[9].end = house.surfaces.back().start = half;  // two rooms below
  house.surfaces.push_back(above);
  Scene scene;
  const uint32_t patch = scene.Add(above.start, above.end, 0.1, above.z_max_m - 0.1);
  const SurfaceId found = scene.Of(house, patch);
  ASSERT_TRUE(found.valid());
  EXPECT_EQ(house.surfaces[found.index()].wall, house.surfaces[9].wall);
}

TEST(MatchSurfaces, APatchAlongTwoWallsIsOfBoth) {
  AGraph house = test::MakeHouse();
  house.walls.push_back(
      house.walls[house.surfaces[8].wall.index()]);  // room C's part of the south wall is a wall of its own, planned 0.2 m further in
  house.surfaces[8].wall = WallId(house.walls.size() - 1);
  house.surfaces[8].start.y() = house.surfaces[8].end.y() = 0.2;
  house.surfaces[8].d_m = -0.2;
  Scene scene;
  const uint32_t patch = scene.Add({0.2, 0}, {8.8, 0});
  std::vector<Observation>& views = scene.map.surfaces[patch].observations;
  views.assign(2, {});
  for (const double z_m : {0.2, 2.0}) {
    for (const double x : {0.2, 4.6}) views[0].stats.Add({x, 0, z_m});
    for (const double x : {5.4, 8.8}) views[1].stats.Add({x, 0, z_m});
  }
  const auto matches = MatchSurfaces(scene.map, house, Eigen::Isometry3d::Identity(), {});
  ASSERT_EQ(matches.size(), 2u);
  EXPECT_EQ(matches[0].plan_surface, SurfaceId(0));
  EXPECT_EQ(matches[0].mistaken, std::vector<uint32_t>{1});
  EXPECT_EQ(matches[1].plan_surface, SurfaceId(8));
  EXPECT_EQ(matches[1].mistaken, std::vector<uint32_t>{0});
  EXPECT_NEAR(matches[1].offset_m, -0.2, 1e-9);
}

// The wall is turned: half of it is behind where it was planned, and seen there past the line that something else of its plane lies on.
TEST(MatchSurfaces, AWallIsNotWhereItIsSeenPast) {
  const AGraph house = test::MakeHouse();
  Scene scene;
  const Eigen::Vector2d south(8.6, 0.3), north(9.6, 5.7);
  const uint32_t wall = scene.Add(south, north, 0.2, 2.4), planned = scene.Add({9, 0.3}, {9, 2.8}, 0.2, 2.5);
  EXPECT_EQ(scene.Of(house, planned), SurfaceId(9));  // nothing speaks against it yet
  scene.See({7, 3, 1}, south, north, 0.2, 2.4);
  EXPECT_EQ(scene.Of(house, wall), SurfaceId(9));
  EXPECT_FALSE(scene.Of(house, planned).valid());
}

TEST(MatchSurfaces, TellsHowMuchOfAPatchLiesBesidePlannedFaces) {
  AGraph house = test::MakeHouse();
  Scene scene;
  scene.Add({9, 2}, {9, 10});  // the wall ends at y = 6
  const auto ratio = [&] { return MatchSurfaces(scene.map, house, Eigen::Isometry3d::Identity(), {}).at(0).beside_ratio; };
  EXPECT_NEAR(ratio(), 0.5, 0.01);
  Surface on = house.surfaces[9];  // of another wall: in the same plane, ...
  on.wall = WallId(house.walls.size());
  house.walls.push_back(house.walls[house.surfaces[9].wall.index()]);
  std::tie(on.start, on.end) = std::pair(Eigen::Vector2d(9, 7), Eigen::Vector2d(9, 9));
  house.surfaces.push_back(on);
  EXPECT_NEAR(ratio(), 0.75, 0.01);
  for (Eigen::Vector2d* at : {&house.surfaces.back().start, &house.surfaces.back().end}) at->x() += 0.1;  // ... or 10 cm behind it
  EXPECT_NEAR(ratio(), 0.5, 0.01);
}

TEST(CouplingOptions, CheckNamesFieldValueAndRule) {
  EXPECT_EQ(CouplingOptions{}.Check(), "");
  CouplingOptions options;
  options.min_overlap_ratio = 1.5;
  EXPECT_EQ(options.Check(), "CouplingOptions.min_overlap_ratio = 1.5; must be in [0, 1]");
}

}  // namespace
}  // namespace plumb::runtime
