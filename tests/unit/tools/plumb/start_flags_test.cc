#include "tools/plumb/start_flags.h"

#include <gtest/gtest.h>

#include "tests/support/house.h"

namespace plumb::tools {
namespace {

TEST(StartHint, TakesAPlaceAndRooms) {
  AGraph house = test::MakeHouse();
  house.rooms[0].name = "6 K\u00fcche";
  const auto hint = ParseStartHint("1,2.5,0.5", {"kueche", "B", "6"}, house);
  ASSERT_TRUE(hint) << hint.error().message;
  EXPECT_EQ(*hint->near_m, Eigen::Vector2d(1, 2.5));
  EXPECT_EQ(hint->near_sigma_m, 0.5);
  EXPECT_EQ(hint->rooms, (std::vector<RoomId>{RoomId(0), RoomId(1)})) << "each once";
  EXPECT_TRUE(ParseStartHint("-15,2", {}, house)) << "a little beside the plan";
}

TEST(StartHint, NamesWhatThePlanDoesNotHave) {
  const AGraph house = test::MakeHouse();
  for (const char* near : {"1", "1,2,3,4", "a,b", "1,2,-1", "100,2", "nan,0"}) {
    const auto hint = ParseStartHint(near, {}, house);
    ASSERT_FALSE(hint) << near;
    EXPECT_EQ(hint.error().message.find("--near"), 0u) << hint.error().message;
  }
  EXPECT_EQ(ParseStartHint("", {"attic"}, house).error().message.find("--room attic: "), 0u);
}

TEST(Mount, TellsWhatIsUpInTheLidarsFrame) {
  const struct {
    const char* mount;
    Eigen::Vector3d up;
  } cases[] = {{"", {0, 0, 1}},
               {"0,0", {0, 0, 1}},
               {"180,0", {0, 0, -1}},
               {"90,0", {0, 1, 0}},
               {"-90,0", {0, -1, 0}},
               {"0,90", {-1, 0, 0}},
               {"90,90", {-1, 0, 0}},
               {"180,180", {0, 0, 1}},
               {"0,30", {-0.5, 0, std::sqrt(0.75)}},
               {"90,30", {-0.5, std::sqrt(0.75), 0}}};
  for (const auto& c : cases) {
    const auto up = ParseMount(c.mount);
    ASSERT_TRUE(up) << c.mount;
    EXPECT_LT((*up - c.up).norm(), 1e-12) << c.mount << ": " << up->transpose();
  }
}

TEST(Mount, NamesWhatIsNoMount) {
  for (const char* mount : {"180", "1,2,3", "x,0", "0,", "nan,0", "0,inf"}) {
    const auto up = ParseMount(mount);
    ASSERT_FALSE(up) << mount;
    EXPECT_EQ(up.error().code, ErrorCode::kBadOption);
    EXPECT_NE(up.error().message.find(mount), std::string::npos);
  }
}

}  // namespace
}  // namespace plumb::tools
