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

TEST(AGraphJson, SurvivesNamesThatAreNoUtf8) {
  AGraph house = test::MakeHouse();
  house.rooms[0].name = "K\xfc" "che";
  EXPECT_TRUE(nlohmann::json::accept(AGraphToJson(house)));
}

}  // namespace
}  // namespace plumb
