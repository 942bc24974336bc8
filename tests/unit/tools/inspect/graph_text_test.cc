#include "tools/inspect/graph_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/house.h"

namespace plumb::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(GraphText, CountsWithPluralsOnlyWhereThereAreSeveral) {
  const std::string text = AGraphToText(test::MakeHouse(), 1);
  EXPECT_THAT(text, HasSubstr("contents  1 storey, 6 walls, "));
  EXPECT_THAT(text, HasSubstr(" 1 triangle\n"));
}

TEST(GraphText, TellsHowDoorsOpen) {
  AGraph house = test::MakeHouse();
  EXPECT_THAT(AGraphToText(house, 0), Not(HasSubstr("leaves ")));
  for (Doorway& d : house.doorways) d.has_leaf = true;
  house.doorways[0].leaves = {{LeafOperation::kSwing, Jamb::kLeft, DoorwaySide::kRoomB}};
  house.doorways[2].leaves = {{LeafOperation::kSliding, Jamb::kLeft}, {LeafOperation::kSliding, Jamb::kRight}};
  const std::string text = AGraphToText(house, 0);
  EXPECT_THAT(text, HasSubstr("leaves    of 2 of 3 doors known: 1 double sliding, 1 single swing\n"));
  EXPECT_THAT(text, HasSubstr("A - B, 0.90 m wide, swing into B at the left\n"));
  EXPECT_THAT(text, HasSubstr(" m wide, sliding to the left and sliding to the right\n"));
}

}  // namespace
}  // namespace plumb::tools
