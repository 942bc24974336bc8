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

}  // namespace
}  // namespace plumb::compiler
