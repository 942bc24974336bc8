// Every folder of plans/ is compiled and compared with its expected.json, whose numbers were worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compiler/compile.h"
#include "schema/agraph_json.h"

namespace plumb {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

std::vector<std::string> PlanFolders() {
  std::vector<std::string> folders;
  for (const auto& entry : fs::directory_iterator(fs::path(PLUMB_SOURCE_DIR) / "plans")) {
    if (fs::exists(entry.path() / "expected.json")) folders.push_back(entry.path().filename().string());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

fs::path DrawingIn(const fs::path& folder) {
  for (const char* ending : {".ifc", ".dxf"}) {
    if (fs::exists(folder / (std::string("plan") + ending))) return folder / (std::string("plan") + ending);
  }
  return {};
}

// Without it an empty folder would pass all tests.
TEST(PlanFolders, AreNotEmpty) { EXPECT_FALSE(PlanFolders().empty()); }

class Plans : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const fs::path folder = fs::path(PLUMB_SOURCE_DIR) / "plans" / GetParam();
    expected_ = Json::parse(std::ifstream(folder / "expected.json"));
    const compiler::CompileResult result = compiler::Compile(DrawingIn(folder).string());
    ASSERT_TRUE(result.graph) << compiler::DiagnosticsToText(result.diagnostics.all(), GetParam());
    EXPECT_FALSE(result.diagnostics.has_errors()) << compiler::DiagnosticsToText(result.diagnostics.all(), GetParam());
    graph_ = Json::parse(AGraphToJson(*result.graph));
  }

  // The one entry of an array of the graph with this guid.
  [[nodiscard]] const Json& ByGuid(const char* array, const std::string& guid) const {
    static const Json none;
    for (const Json& entry : graph_.at(array)) {
      if (entry.at("guid") == guid) return entry;
    }
    ADD_FAILURE() << "no entry of `" << array << "` has the guid " << guid;
    return none;
  }

  // Guid of a room by its id, null for outside.
  [[nodiscard]] Json RoomGuid(const Json& id) const { return id.is_null() ? id : graph_.at("rooms").at(id.get<size_t>()).at("guid"); }

  Json expected_, graph_;
};

TEST_P(Plans, HasTheExpectedCounts) {
  for (const auto& [array, count] : expected_.at("counts").items()) EXPECT_EQ(graph_.at(array).size(), count.get<size_t>()) << array;
}

TEST_P(Plans, HasTheExpectedStoreysAndWalls) {
  for (const Json& storey : expected_.at("storeys")) {
    const Json& found = ByGuid("storeys", storey.at("guid"));
    if (found.is_null()) continue;
    EXPECT_EQ(found.at("name"), storey.at("name"));
    EXPECT_NEAR(found.at("elevation_m").get<double>(), storey.at("elevation_m").get<double>(), 1e-4);
  }
  for (const Json& wall : expected_.at("walls")) {
    const Json& found = ByGuid("walls", wall.at("guid"));
    if (found.is_null()) continue;
    EXPECT_EQ(found.at("name"), wall.at("name"));
    EXPECT_NEAR(found.at("thickness_m").get<double>(), wall.at("thickness_m").get<double>(), 1e-3) << wall.at("name");
    EXPECT_EQ(found.at("external"), wall.at("external")) << wall.at("name");
  }
}

TEST_P(Plans, HasTheExpectedRoomsToASquareCentimetre) {
  for (const Json& room : expected_.at("rooms")) {
    const Json& found = ByGuid("rooms", room.at("guid"));
    if (found.is_null()) continue;
    EXPECT_EQ(found.at("name"), room.at("name"));
    // Rooms with curved walls are polygons in the graph.
    EXPECT_NEAR(found.at("area_m2").get<double>(), room.at("area_m2").get<double>(), room.value("area_tolerance_m2", 1e-4))
        << room.at("name");
    EXPECT_GE(found.at("surfaces").size(), room.value("surfaces", 4u)) << room.at("name");
  }
}

TEST_P(Plans, HasTheExpectedDoorwaysBetweenTheirRooms) {
  for (const Json& doorway : expected_.at("doorways")) {
    const auto at = doorway.at("position").get<std::vector<double>>();
    const Json* found = nullptr;
    for (const Json& d : graph_.at("doorways")) {
      const Json& p = d.at("position");
      if (std::hypot(p.at(0).get<double>() - at[0], p.at(1).get<double>() - at[1]) < 0.01) found = &d;
    }
    ASSERT_TRUE(found) << doorway.at("name");
    EXPECT_EQ(found->at("name"), doorway.at("name"));
    EXPECT_EQ(found->at("has_leaf"), doorway.at("has_leaf")) << doorway.at("name");
    EXPECT_NEAR(found->at("width_m").get<double>(), doorway.at("width_m").get<double>(), 1e-3) << doorway.at("name");
    EXPECT_NEAR(found->at("height_m").get<double>(), doorway.at("height_m").get<double>(), 1e-3) << doorway.at("name");
    const Json &a = doorway.at("rooms").at(0), &b = doorway.at("rooms").at(1);
    const Json found_a = RoomGuid(found->at("rooms").at(0)), found_b = RoomGuid(found->at("rooms").at(1));
    EXPECT_TRUE((found_a == a && found_b == b) || (found_a == b && found_b == a))
        << doorway.at("name") << ": " << found_a << ", " << found_b;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Plans, ::testing::ValuesIn(PlanFolders()), [](const auto& plan) { return plan.param; });

}  // namespace
}  // namespace plumb
