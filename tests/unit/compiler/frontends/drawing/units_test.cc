#include "compiler/frontends/drawing/units.h"

#include <gtest/gtest.h>

namespace plumb::compiler {
namespace {

Drawing RoomOf(double thickness, double length) {
  Drawing out;
  for (const double y : {0.0, thickness, 0.7 * length, 0.7 * length + thickness}) {
    DrawnPath path;
    path.role = LineRole::kWall;
    path.points = {{0, y}, {length, y}};
    out.paths.push_back(path);
  }
  return out;
}

TEST(Units, SizesAreThoseOfWallsNotOfRooms) {
  const DrawnSizes sizes = MeasureSizes(RoomOf(150, 6000));
  EXPECT_NEAR(sizes.wall, 150, 1e-9);
  EXPECT_NEAR(sizes.extent, 6000, 1e-9);
  EXPECT_EQ(sizes.door, 0);
}

TEST(Units, StatedUnitHoldsWhereSizesAreUsual) {
  const UnitChoice choice = ChooseUnit({150, 850, 20000}, FindUnit("mm"));
  EXPECT_TRUE(choice.stated_holds);
  EXPECT_EQ(choice.unit.name, "mm");
}

// A corridor of rooms of 3 m, drawn as single lines: their distance is no thickness.
TEST(Units, StatedUnitHoldsForWallsAsFarApartAsRooms) {
  const UnitChoice choice = ChooseUnit({3, 0, 120}, FindUnit("m"));
  EXPECT_TRUE(choice.stated_holds);
  EXPECT_EQ(choice.unit.name, "m");
}

TEST(Units, InchesUnderAHeaderOfMillimetresAreFound) {
  const UnitChoice choice = ChooseUnit({5.5, 30, 790}, FindUnit("mm"));
  EXPECT_FALSE(choice.stated_holds);
  EXPECT_EQ(choice.unit.name, "in");
}

TEST(Units, EachUsualUnitIsGuessedFromSizesInIt) {
  for (const char* name : {"mm", "cm", "m", "in", "ft"}) {
    const LengthUnit unit = *FindUnit(name);
    const UnitChoice choice = ChooseUnit({0.2 / unit.metres, 0.9 / unit.metres, 15 / unit.metres}, std::nullopt);
    EXPECT_EQ(choice.unit.name, name);
  }
}

TEST(Units, ThickWallsWithoutBetterUnitKeepTheStatedOne) {
  const UnitChoice choice = ChooseUnit({0.8, 0, 30}, FindUnit("m"));  // a castle
  EXPECT_EQ(choice.unit.name, "m");
  EXPECT_FALSE(FindUnit("furlong"));
}

}  // namespace
}  // namespace plumb::compiler
