#include "schema/agraph_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/house.h"

namespace plumb {
namespace {

TEST(AGraphJson, HasTheDocumentedArraysAndKeys) {
  const nlohmann::json json = nlohmann::json::parse(AGraphToJson(test::MakeHouse()));
  for (const char* array : {"storeys", "walls", "surfaces", "rooms", "doorways", "windows"}) {
    ASSERT_TRUE(json.contains(array)) << array;
    for (const auto& entry : json[array]) {
      for (const char* key : {"id", "guid", "name", "storey"}) EXPECT_TRUE(entry.contains(key)) << array << "." << key;
    }
  }
  const auto& room = json["rooms"][2];
  EXPECT_EQ(room["name"], "C");
  EXPECT_DOUBLE_EQ(room["area_m2"], 23.64);
  EXPECT_EQ(room["polygon"].size(), 4u);
  EXPECT_EQ(room["surfaces"].size(), 4u);
  const auto& door = json["doorways"][2];
  EXPECT_EQ(door["rooms"][0], 0);
  EXPECT_TRUE(door["rooms"][1].is_null());
  EXPECT_DOUBLE_EQ(door["width_m"], 0.9);
}

TEST(AGraphJson, TellsHowLeavesOpen) {
  AGraph house = test::MakeHouse();
  house.doorways[0].leaves = {{LeafOperation::kSwing, Jamb::kLeft, DoorwaySide::kRoomB, 0.9}, {}};
  house.doorways[1].leaves = {{LeafOperation::kDoubleActing, Jamb::kRight, DoorwaySide::kRoomA}};
  const nlohmann::json doorways = nlohmann::json::parse(AGraphToJson(house))["doorways"];
  const nlohmann::json swing = {{"operation", "swing"}, {"jamb", "left"}, {"opens_to", 1}, {"width_m", 0.9}};
  const nlohmann::json unknown = {{"operation", nullptr}, {"jamb", nullptr}, {"opens_to", nullptr}, {"width_m", nullptr}};
  EXPECT_EQ(doorways[0]["leaves"], (nlohmann::json{swing, unknown}));
  EXPECT_EQ(doorways[1]["leaves"][0]["operation"], "double-acting");
  EXPECT_EQ(doorways[1]["leaves"][0]["jamb"], "right");
  EXPECT_EQ(doorways[1]["leaves"][0]["opens_to"], 0);
  EXPECT_TRUE(doorways[2]["leaves"].empty());
}

TEST(AGraphJson, SurvivesNamesThatAreNoUtf8) {
  AGraph house = test::MakeHouse();
  house.rooms[0].name =
      "K\xfc"
      "che";
  EXPECT_TRUE(nlohmann::json::accept(AGraphToJson(house)));
}

}  // namespace
}  // namespace plumb
