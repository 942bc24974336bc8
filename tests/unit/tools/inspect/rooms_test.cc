#include "tools/inspect/rooms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/house.h"

namespace plumb::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class FindRoomsOfAHouse : public ::testing::Test {
 protected:
  FindRoomsOfAHouse() {
    house_.rooms[0].name = "6 K\u00fcche";
    house_.rooms[1].name = "7 Bad";
    house_.rooms[2].name = "Bad";
    house_.rooms[2].guid = "0Lt8gR";
  }
  std::string Refusal(const std::string& name) const { return FindRooms(house_, name).error().message; }

  AGraph house_ = test::MakeHouse();
};

TEST_F(FindRoomsOfAHouse, TakesExactNamesFirst) {
  EXPECT_THAT(*FindRooms(house_, "Bad"), ElementsAre(RoomId(2)));
  EXPECT_THAT(*FindRooms(house_, "0Lt8gR"), ElementsAre(RoomId(2)));
  EXPECT_THAT(*FindRooms(house_, "BAD"), ElementsAre(RoomId(2)));
  house_.rooms[1].name = "Bad";
  EXPECT_THAT(*FindRooms(house_, "Bad"), ElementsAre(RoomId(1), RoomId(2)));
}

TEST_F(FindRoomsOfAHouse, TakesNamesAsTheyAreTyped) {
  for (const char* typed : {"6 kueche", "Kueche", "kuche", "KÜCHE", "6"})
    EXPECT_THAT(*FindRooms(house_, typed), ElementsAre(RoomId(0))) << typed;
}

TEST_F(FindRoomsOfAHouse, SaysWhichThereAre) {
  EXPECT_THAT(Refusal("Kuechr"), HasSubstr("did you mean `6 K\u00fcche`?"));
  EXPECT_THAT(Refusal("Bat"), HasSubstr("did you mean `7 Bad` or `Bad`?"));
  EXPECT_THAT(Refusal("Gymnasium"), HasSubstr("no such room, but `6 K\u00fcche`, `7 Bad` and `Bad`; "));
  EXPECT_THAT(Refusal(""), HasSubstr("no such room"));
  house_.rooms.clear();
  EXPECT_EQ(Refusal("Bad"), "the plan has no rooms");
}

}  // namespace
}  // namespace plumb::tools
