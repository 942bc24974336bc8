#include "tools/inspect/storeys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/house.h"

namespace plumb::tools {
namespace {

AGraph ThreeStoreys() {
  AGraph g = test::MakeHouse();
  g.storeys.push_back({"s1", "First floor", 3, 3});
  g.storeys.push_back({"s2", "first FLOOR", 6, 3});
  return g;
}

TEST(FindStorey, TakesNamesAndNumbers) {
  const AGraph g = ThreeStoreys();
  EXPECT_EQ(FindStorey(g, "Ground floor"), StoreyId(0));
  EXPECT_EQ(FindStorey(g, "ground floor"), StoreyId(0));
  EXPECT_EQ(FindStorey(g, "First floor"), StoreyId(1));  // exactly
  EXPECT_EQ(FindStorey(g, "2"), StoreyId(2));
}

TEST(FindStorey, RefusesWhatIsNoneOrNotOne) {
  const AGraph g = ThreeStoreys();
  for (const char* name : {"3", "-1", "Attic", "FIRST FLOOR", "1x", ""}) {
    const auto found = FindStorey(g, name);
    ASSERT_FALSE(found) << name;
    EXPECT_EQ(found.error().code, ErrorCode::kBadOption);
    EXPECT_THAT(found.error().message, ::testing::HasSubstr("`First floor` (1)"));
  }
}

TEST(FindStorey, PrefersANameToANumber) {
  AGraph g = ThreeStoreys();
  g.storeys[2].name = "0";
  EXPECT_EQ(FindStorey(g, "0"), StoreyId(2));
}

TEST(MainStorey, HasTheMostRooms) {
  AGraph g = ThreeStoreys();
  EXPECT_EQ(MainStorey(g), StoreyId(0));
  g.rooms[2].storey = StoreyId(1);
  g.rooms[2].area_m2 = 500;
  EXPECT_EQ(MainStorey(g), StoreyId(0));
  g.rooms[1].storey = StoreyId(1);
  EXPECT_EQ(MainStorey(g), StoreyId(1));
  EXPECT_FALSE(MainStorey(AGraph{}).valid());
}

}  // namespace
}  // namespace plumb::tools
