#include "compiler/frontends/drawing/wall_mass.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/unit/compiler/frontends/drawing/draw.h"

namespace plumb::compiler {
namespace {

using test::AddBox;

WallMass MassOf(const Drawing& drawing) {
  std::vector<uint32_t> all(drawing.paths.size());
  std::iota(all.begin(), all.end(), 0u);
  auto mass = FindWallMass(drawing, all, {});
  EXPECT_TRUE(mass);
  return mass.value_or(WallMass());
}

bool IsWall(const WallMass& mass, double x, double y) { return mass.is_wall[mass.map.FaceAt({x, y})]; }

// A room of 4 m by 4 m, a closet 0.3 m deep along its north side, walls 0.3 m thick.
Drawing RoomWithCloset() {
  Drawing out;
  AddBox(-0.3, -0.3, 4.3, 4.9, out);
  AddBox(0, 0, 4, 4, out);
  AddBox(0, 4.3, 4, 4.6, out);
  return out;
}

TEST(WallMass, LiesBetweenTheSidesOfWalls) {
  const WallMass mass = MassOf(RoomWithCloset());
  EXPECT_TRUE(IsWall(mass, -0.15, 2));
  EXPECT_TRUE(IsWall(mass, 2, 4.15));
  EXPECT_FALSE(IsWall(mass, 2, 2));
  EXPECT_FALSE(IsWall(mass, 10, 2));
  EXPECT_NEAR(mass.typical_thickness_m, 0.3, 0.01);
}

TEST(WallMass, AClosetAsNarrowAsAWallIsFreeWhereTheDrawingOutlinesItAsARoom) {
  Drawing drawing = RoomWithCloset();
  EXPECT_TRUE(IsWall(MassOf(drawing), 2, 4.45)) << "its lines alone are those of a wall";
  drawing.spaces.push_back({"Closet", drawing.paths[2].points, {}});
  const WallMass mass = MassOf(drawing);
  EXPECT_FALSE(IsWall(mass, 2, 4.45));
  EXPECT_TRUE(IsWall(mass, 2, 4.15)) << "the wall beside it stays";
  EXPECT_TRUE(IsWall(mass, 2, 4.75));
}

TEST(WallMass, AClosetIsFreeAlsoWhereItsRoomIsDrawnToTheMiddleOfTheWalls) {
  Drawing drawing = RoomWithCloset();
  drawing.spaces.push_back({"Closet", {{-0.05, 4.25}, {4.05, 4.25}, {4.05, 4.65}, {-0.05, 4.65}}, {}});
  EXPECT_TRUE(IsWall(MassOf(drawing), 2, 4.15));
}

TEST(WallMass, ARoomsOutlineFreesNoWallThatReachesBeyondIt) {
  Drawing drawing = RoomWithCloset();
  drawing.spaces.push_back({"Room", drawing.paths[1].points, {}});
  const WallMass mass = MassOf(drawing);
  EXPECT_TRUE(IsWall(mass, 2, 4.15));
  EXPECT_TRUE(IsWall(mass, -0.15, 2));
  EXPECT_FALSE(IsWall(mass, 2, 2));
}

// A wall 4 m long and 0.2 m thick in four lines, the first of which starts at `from` instead of (0, 0).
Drawing WallFrom(const Eigen::Vector2d& from) {
  Drawing out;
  const std::vector<Eigen::Vector2d> corners = {{0, 0}, {4, 0}, {4, 0.2}, {0, 0.2}};
  for (size_t k = 0; k < 4; ++k) {
    DrawnPath path;
    path.points = {corners[k], corners[(k + 1) % 4]};
    path.role = LineRole::kWall;
    out.paths.push_back(std::move(path));
  }
  out.paths[0].points[0] = from;
  return out;
}

TEST(WallMass, AnEndBesideItsCornerIsLedThere) {
  for (const Eigen::Vector2d& from : {Eigen::Vector2d(0.005, 0), {0, -0.012}, {0.02, 0.02}, {-0.03, -0.02}}) {
    const WallMass mass = MassOf(WallFrom(from));
    EXPECT_TRUE(IsWall(mass, 2, 0.1)) << from.transpose();
    ASSERT_EQ(mass.heals.size(), 1u) << from.transpose();
    EXPECT_LE(mass.heals[0].distance_m(), from.norm() + 1e-9);
  }
}

TEST(WallMass, WhatRunsOverItsCornerNeedsNoHealing) {
  const WallMass mass = MassOf(WallFrom({-0.02, 0}));
  EXPECT_TRUE(IsWall(mass, 2, 0.1));
  EXPECT_TRUE(mass.heals.empty());
}

TEST(WallMass, WhatIsFarForItsThicknessIsNoSlip) {
  const WallMass mass = MassOf(WallFrom({0.09, 0.09}));
  EXPECT_TRUE(mass.heals.empty());
}

// A room of 8 m by 6 m in walls of 0.2 m with a doorway to the outside, and a rectangle `away_m` outside.
Drawing HouseWithin(double away_m) {
  Drawing out;
  DrawnPath walls;
  walls.points = {{3, 0}, {0, 0}, {0, 6}, {8, 6}, {8, 0}, {4, 0}, {4, 0.2}, {7.8, 0.2}, {7.8, 5.8}, {0.2, 5.8}, {0.2, 0.2}, {3, 0.2}};
  walls.closed = true;
  out.paths.push_back(std::move(walls));
  AddBox(-away_m, -away_m, 8 + away_m, 6 + away_m, out);
  for (DrawnPath& path : out.paths) path.role = LineRole::kWall;
  return out;
}

TEST(WallMass, ALineRoundTheBuildingFillsNothing) {
  for (const double away_m : {0.2, 0.3, 0.5, 0.6}) {
    const WallMass mass = MassOf(HouseWithin(away_m));
    EXPECT_FALSE(IsWall(mass, 4, 3)) << away_m;
    EXPECT_FALSE(IsWall(mass, -0.5 * away_m, 3)) << away_m;
    EXPECT_TRUE(IsWall(mass, 0.1, 3)) << away_m;
  }
}

// A line 0.6 m outside round two sides of a room in walls of 0.1 m.
TEST(WallMass, ALedgeAlongAWallIsNoWall) {
  Drawing drawing;
  AddBox(0, 0, 8, 6, drawing);
  AddBox(0.1, 0.1, 7.9, 5.9, drawing);
  drawing.paths.push_back({});
  drawing.paths.back().points = {{8, 1}, {8.6, 1}, {8.6, 6.6}, {3, 6.6}, {3, 6}};
  for (DrawnPath& path : drawing.paths) path.role = LineRole::kWall;
  const WallMass mass = MassOf(drawing);
  EXPECT_FALSE(IsWall(mass, 8.3, 3));
  EXPECT_TRUE(IsWall(mass, 7.95, 3));
}

// Two walls 0.1 m thick: the second ends `short_m` before the first, across which it stands.
TEST(WallMass, ALineThatStopsShortOfAWallIsToldOf) {
  for (const double short_m : {0.035, 0.059}) {
    Drawing drawing;
    AddBox(0, 0, 4, 0.1, drawing);
    for (const double x : {2.0, 2.1}) {
      drawing.paths.push_back({});
      drawing.paths.back().points = {{x, 0.1 + short_m}, {x, 3}};
    }
    const WallMass mass = MassOf(drawing);
    EXPECT_TRUE(IsWall(mass, 2.05, 1));
    ASSERT_EQ(mass.heals.size(), 2u) << short_m << ": not the cap at the other end";
    EXPECT_NEAR(mass.heals[0].distance_m(), short_m, 1e-6);
    EXPECT_EQ(mass.heals[0].other, 0u);
  }
}

TEST(WallMass, ABreakIsToldOf) {
  Drawing drawing = WallFrom({0, 0});
  DrawnPath rest = drawing.paths[0];
  drawing.paths[0].points[1] = {1.9, 0};
  rest.points[0] = {2.05, 0};
  drawing.paths.push_back(std::move(rest));
  const WallMass mass = MassOf(drawing);
  EXPECT_TRUE(IsWall(mass, 2, 0.1));
  ASSERT_EQ(mass.heals.size(), 1u);
  EXPECT_NEAR(mass.heals[0].distance_m(), 0.15, 1e-6);
}

TEST(MassOptions, AreChecked) {
  EXPECT_EQ(MassOptions().Check(), "");
  for (double MassOptions::*value :
       {&MassOptions::heal_share, &MassOptions::max_undershoot_m, &MassOptions::max_break_m, &MassOptions::min_thickness_m}) {
    MassOptions options;
    options.*value = -1;
    EXPECT_NE(options.Check(), "");
  }
}

// Outer walls 0.4 m thick around many partitions of 0.1 m: two outlines, one within the other.
TEST(WallMass, ARingMuchThickerThanMostWallsIsAWallOnALayerOfWalls) {
  Drawing drawing;
  AddBox(0, 0, 10, 8, drawing);
  AddBox(0.4, 0.4, 9.6, 7.6, drawing);
  for (int i = 1; i < 9; ++i) AddBox(i, 1, i + 0.1, 7, drawing);
  EXPECT_FALSE(IsWall(MassOf(drawing), 0.2, 4)) << "lines alone do not tell";
  for (DrawnPath& path : drawing.paths) path.role = LineRole::kWall;
  const WallMass mass = MassOf(drawing);
  EXPECT_TRUE(IsWall(mass, 0.2, 4));
  EXPECT_TRUE(IsWall(mass, 3.05, 4));
  EXPECT_FALSE(IsWall(mass, 3.5, 4));
}

}  // namespace
}  // namespace plumb::compiler
