#include "compiler/frontends/svg/svg_scale.h"

#include <gtest/gtest.h>

namespace plumb::compiler {
namespace {

using Origin = ScaleChoice::Origin;

TEST(ChooseScale, TakesThePageWhereTheSizesHold) {
  const ScaleChoice choice = ChooseScale({.wall = 120, .door = 800, .extent = 12000}, 0.001, {});
  EXPECT_EQ(choice.origin, Origin::kStated);
  EXPECT_DOUBLE_EQ(choice.metres, 0.001);
}

TEST(ChooseScale, TakesTheRatioThatATextStates) {
  const ScaleChoice choice = ChooseScale({.wall = 1.2, .door = 8, .extent = 150}, 0.001, {5, 100});
  EXPECT_EQ(choice.origin, Origin::kRatio);
  EXPECT_DOUBLE_EQ(choice.metres, 0.1);
}

TEST(ChooseScale, TakesTheUsualRatioThatIsNearTheSizes) {
  const ScaleChoice choice = ChooseScale({.wall = 2.4, .door = 18, .extent = 200}, 0.001, {});
  EXPECT_EQ(choice.origin, Origin::kSizes);
  EXPECT_DOUBLE_EQ(choice.metres, 0.05);
}

TEST(ChooseScale, TakesDoorsForUsualWhereNothingIsStated) {
  const ScaleChoice choice = ChooseScale({.wall = 2, .door = 11.3, .extent = 900}, std::nullopt, {});
  EXPECT_EQ(choice.origin, Origin::kSizes);
  EXPECT_NEAR(choice.metres * 11.3, UnitOptions().usual_door_m, 1e-9);
  EXPECT_NE(choice.reason.find("does not state"), std::string::npos);
}

TEST(ChooseScale, TakesAUnitThatPlansAreDrawnIn) {
  EXPECT_DOUBLE_EQ(ChooseScale({.wall = 12, .door = 82, .extent = 1400}, std::nullopt, {}).metres, 0.01);
}

TEST(RatiosIn, ReadsThemInTexts) {
  Drawing drawing;
  for (const char* text : {"Maßstab 1:100", "M 1 : 50", "11:30", "1:1", "Room 1"}) drawing.texts.push_back({.text = text, .location = {}});
  EXPECT_EQ(RatiosIn(drawing), (std::vector<double>{100, 50}));
}

// A round hall in circles: nothing tells of walls or doors, so that the page is to be believed.
TEST(SvgScale, AStatedUnitStaysWhereNothingSpeaksAgainstIt) {
  const ScaleChoice none = ChooseScale({}, 0.01, {}, {});
  EXPECT_EQ(none.origin, ScaleChoice::Origin::kStated);
  EXPECT_EQ(none.metres, 0.01);
  DrawnSizes hall;
  hall.extent = 640;
  const ScaleChoice choice = ChooseScale(hall, 0.01, {}, {});
  EXPECT_EQ(choice.origin, ScaleChoice::Origin::kStated);
  EXPECT_EQ(choice.metres, 0.01);
}

}  // namespace
}  // namespace plumb::compiler
