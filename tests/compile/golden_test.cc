// Golden test on a real house, AC14-FZK-Haus of Debian's assimp-testmodels. PLUMB_UPDATE_GOLDEN=1 rewrites the golden file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "compiler/compile.h"
#include "compiler/passes/polygon.h"
#include "compiler/validate_graph.h"
#include "schema/agraph_json.h"
#include "schema/agraph_reader.h"
#include "schema/agraph_writer.h"
#include "schema/files.h"

namespace plumb::compiler {
namespace {

constexpr char kGolden[] = PLUMB_SOURCE_DIR "/tests/compile/golden/AC14-FZK-Haus.json";

std::string HousePath() {
  for (const char* folder : {"models", "models-nonbsd"}) {
    for (const char* suffix : {"", ".gz"}) {
      const std::string path = std::string("/usr/share/assimp/") + folder + "/IFC/AC14-FZK-Haus.ifc" + suffix;
      if (std::filesystem::exists(path)) return path;
    }
  }
  return {};
}

class FzkHaus : public testing::Test {
 protected:
  void SetUp() override {
    const std::string path = HousePath();
    if (path.empty()) GTEST_SKIP() << "the package assimp-testmodels is not installed";
    CompileOptions options;
    options.verify_stages = true;
    result_ = Compile(path, options);
    ASSERT_TRUE(result_.graph.has_value()) << DiagnosticsToText(result_.diagnostics.all(), path);
  }

  const AGraph& graph() const { return *result_.graph; }
  const Room* RoomNamed(const std::string& name) const {
    for (const Room& r : graph().rooms) {
      if (r.name == name) return &r;
    }
    return nullptr;
  }
  std::string NameOf(RoomId id) const { return id.valid() ? graph().rooms[id.index()].name : "outside"; }

  CompileResult result_;
};

TEST_F(FzkHaus, HasItsStoreysWallsAndOpenings) {
  EXPECT_EQ(graph().storeys.size(), 2u);
  EXPECT_EQ(graph().walls.size(), 13u);
  EXPECT_EQ(graph().doorways.size(), 5u);
  EXPECT_EQ(graph().windows.size(), 11u);
  EXPECT_GT(graph().mesh.triangles.size(), 10000u);
  for (const Wall& w : graph().walls) {
    EXPECT_FALSE(w.guid.empty());
    EXPECT_NEAR(w.thickness_m, w.external ? 0.3 : 0.24, 1e-6);
  }
  EXPECT_EQ(result_.diagnostics.Count(Severity::kError), 0u);
}

TEST_F(FzkHaus, RoomsAreThoseOfTheSpaces) {
  // Inner measures as drawn in the plan.
  const std::map<std::string, Ring> expected = {
      {"1 Küche", {{0.3, 0.3}, {3.8, 0.3}, {3.8, 4.01}, {0.3, 4.01}}},
      {"2 Buero", {{0.3, 5.99}, {3.8, 5.99}, {3.8, 9.7}, {0.3, 9.7}}},
      {"3 Bad", {{4.04, 5.99}, {7.41, 5.99}, {7.41, 9.7}, {4.04, 9.7}}},
      {"4 Schlafzimmer", {{7.65, 4.25}, {11.7, 4.25}, {11.7, 9.7}, {7.65, 9.7}}},
      {"5 Wohnen", {{3.8, 0.3}, {11.7, 0.3}, {11.7, 4.01}, {3.8, 4.01}}},
      {"6 Flur", {{0.3, 4.25}, {3.8, 4.25}, {3.8, 4.01}, {7.41, 4.01}, {7.41, 5.75}, {0.3, 5.75}}},
      {"7 Galerie", {{0.3, 0.3}, {11.7, 0.3}, {11.7, 9.7}, {0.3, 9.7}}}};
  EXPECT_EQ(graph().rooms.size(), expected.size());
  for (const auto& [name, ring] : expected) {
    const Room* room = RoomNamed(name);
    ASSERT_TRUE(room != nullptr) << name;
    const std::vector<Ring> a = {room->polygon}, b = {ring};
    const double overlap = OverlapArea(a, b);
    EXPECT_GE(overlap / (RegionArea(a) + RegionArea(b) - overlap), 0.99) << name;
    EXPECT_EQ(room->storey, StoreyId(name == "7 Galerie" ? 1 : 0));
    EXPECT_FALSE(room->guid.empty());
  }
}

TEST_F(FzkHaus, DoorsJoinTheRightRooms) {
  const std::map<std::string, std::pair<std::string, std::string>> expected = {{"Haustuer", {"6 Flur", "outside"}},
                                                                               {"Terrassentuer", {"5 Wohnen", "outside"}},
                                                                               {"Innentuer-1", {"6 Flur", "4 Schlafzimmer"}},
                                                                               {"Innentuer-2", {"6 Flur", "3 Bad"}},
                                                                               {"Innentuer-3", {"6 Flur", "2 Buero"}}};
  for (const Doorway& d : graph().doorways) {
    const auto it = expected.find(d.name);
    ASSERT_NE(it, expected.end()) << d.name;
    EXPECT_EQ(NameOf(d.room_a), it->second.first) << d.name;
    EXPECT_EQ(NameOf(d.room_b), it->second.second) << d.name;
    EXPECT_TRUE(d.has_leaf);
  }
}

TEST_F(FzkHaus, ValidatesAndReadsBack) {
  for (const Diagnostic& d : ValidateGraph(graph())) {
    // A spiral staircase, no door, leads to the gallery.
    EXPECT_TRUE(d.kind == DiagnosticKind::kRoomWithoutDoorway && d.message.find("Galerie") != std::string::npos) << d.message;
  }
  const std::vector<uint8_t> bytes = WriteAGraph(graph());
  const Expected<AGraph> read = ReadAGraph(bytes);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(AGraphToJson(*read), AGraphToJson(graph()));
}

TEST_F(FzkHaus, CompilesToTheSameBytesTwice) {
  const CompileResult again = Compile(HousePath());
  ASSERT_TRUE(again.graph.has_value());
  EXPECT_EQ(WriteAGraph(graph()), WriteAGraph(*again.graph));
}

// Rooms, doorways and open boundaries of the golden file, to 0.1 mm.
TEST_F(FzkHaus, MatchesTheGoldenFile) {
  const auto full = nlohmann::ordered_json::parse(AGraphToJson(graph()));
  nlohmann::ordered_json kept;
  for (const char* key : {"storeys", "walls", "rooms", "doorways", "windows", "open_boundaries"}) kept[key] = full[key];
  const std::string text = kept.dump(1) + "\n";
  if (const char* update = std::getenv("PLUMB_UPDATE_GOLDEN"); update != nullptr && std::string(update) == "1") {
    ASSERT_TRUE(WriteFileAtomically(kGolden, text));
    GTEST_SKIP() << "rewrote " << kGolden;
  }
  const Expected<std::string> golden = ReadFileText(kGolden);
  ASSERT_TRUE(golden) << golden.error().message << "; PLUMB_UPDATE_GOLDEN=1 writes it";
  EXPECT_EQ(text, *golden) << "PLUMB_UPDATE_GOLDEN=1 rewrites the golden file";
}

}  // namespace
}  // namespace plumb::compiler
