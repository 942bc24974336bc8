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

TEST(Tries, AreReadAsTheyWereWritten) {
  HypothesisRow seen;
  seen.probability = 0.75;
  seen.position_m = {1.5, -2, 3.25};
  seen.yaw_rad = 0.5;
  seen.sigma_xy_m = 0.02;
  seen.storey = "EG";
  seen.room = RoomId(3);
  seen.room_name = "Büro";
  seen.consistent_planes = 5;
  HypothesisRow open = seen;
  open.sigma_xy_m.reset();
  open.room.reset();
  TryRow row{12.5, "ambiguous", "2 places", 0.125, {seen, open}, GuidanceRow{1, DriveToRow()}};
  row.guidance->drive_to->rooms = {RoomId(1), std::nullopt};
  const std::string json = TriesToJson({row, TryRow()});
  const auto tries = ParseTries(json, "hypotheses.json");
  ASSERT_TRUE(tries) << tries.error().message;
  ASSERT_EQ(tries->size(), 2u);
  EXPECT_EQ(TriesToJson(*tries), json);
  ASSERT_EQ((*tries)[0].hypotheses.size(), 2u);
  EXPECT_EQ((*tries)[0].hypotheses[0].position_m, seen.position_m);
  EXPECT_EQ((*tries)[0].hypotheses[0].room, RoomId(3));
  EXPECT_FALSE((*tries)[0].hypotheses[1].sigma_xy_m);
  EXPECT_EQ((*tries)[1].guidance.has_value(), false);
}

TEST(Tries, OfADamagedFileAreAnErrorThatNamesIt) {
  for (const char* json : {"", "{}", R"({"version": 2, "tries": []})", R"({"version": 1, "tries": [{"t": "one"}]})"}) {
    const auto tries = ParseTries(json, "run/hypotheses.json");
    ASSERT_FALSE(tries) << json;
    EXPECT_EQ(tries.error().code, ErrorCode::kBadRunFolder);
    EXPECT_NE(tries.error().message.find("run/hypotheses.json"), std::string::npos);
  }
}

}  // namespace
}  // namespace plumb::tools
