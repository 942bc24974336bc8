#include "tools/run/tries_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace plumb::tools {
namespace {

TEST(Tries, SayWhereToDriveOnlyWherePlacesAreOpen) {
  std::vector<TryRow> tries(3);
  tries[1].guidance = GuidanceRow{2, std::nullopt};
  DriveToRow drive_to;
  drive_to.rooms = {RoomId(4), std::nullopt, RoomId(7)};
  drive_to.room_names = {"Bad", "", "Küche"};
  drive_to.bearing_rad = -1;
  drive_to.distance_m = 6.25;
  drive_to.rivals_split = 2;
  tries[2].guidance = GuidanceRow{2, drive_to};
  const nlohmann::json rows = nlohmann::json::parse(TriesToJson(tries)).at("tries");
  EXPECT_FALSE(rows[0].contains("drive_to"));
  EXPECT_TRUE(rows[1].at("drive_to").is_null());
  EXPECT_EQ(rows[1].at("rivals"), 2);
  const nlohmann::json& d = rows[2].at("drive_to");
  EXPECT_EQ(d.at("rooms"), nlohmann::json::array({4, nullptr, 7}));
  EXPECT_EQ(d.at("room_names")[2], "Küche");
  EXPECT_NEAR(d.at("bearing_deg").get<double>(), -57.3, 1e-9);
  EXPECT_EQ(d.at("distance_m"), 6.25);
  EXPECT_EQ(d.at("rivals_split"), 2);
}

}  // namespace
}  // namespace plumb::tools
