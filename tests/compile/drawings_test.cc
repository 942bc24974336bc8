// Drawings as a whole: those of others against rooms and doorways counted by eye.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "compiler/compile.h"
#include "schema/agraph_writer.h"

namespace plumb::compiler {
namespace {

namespace fs = std::filesystem;

const fs::path kData = fs::path(PLUMB_SOURCE_DIR) / ".." / "shared" / "data";

// `drawn_*`: as a person counts them on the print. `rooms`, `doorways`: what is found; where they differ, `why` says so.
struct Counted {
  const char* path;
  size_t drawn_rooms, drawn_doorways, rooms, doorways;
  const char* why;
};
void PrintTo(const Counted& c, std::ostream* out) { *out << c.path; }

constexpr Counted kCounted[] = {
    {"plans/dxf/benhudson_floorplan.dxf", 9, 9, 9, 9, ""},
    {"plans/dxf/bjnortier_floorplan.dxf", 16, 19, 16, 19,
     "the closet CLO. (0.50 m2) is below the least area of a room; a boxed corner of the great room without a door counts as one"},
    {"plans/dxf/roomsize_two-rooms.dxf", 2, 1, 2, 1, ""},
    {"lidar/fr079/asbuilt.dxf", 18, 23, 18, 23, ""},
    {"lidar/fr079/plan.dxf", 16, 15, 16, 15, ""},
    {"lidar/fr079/asbuilt.svg", 18, 23, 18, 23, ""},
    {"plans/svg/newell-simon_2011_GIS-1.svg", 95, 95, 110, 101,
     "rooms: 1150 is open at its end, the spiral stair 1903 and closets below 0.5 m2 are none; flights of stairs, toilet stalls and corners between "
     "outer lines count as rooms of their own. Doorways: lifts, pairs of leaves drawn at 45 degrees and some frames without a leaf are not found (about 19); "
     "doors of toilet stalls and gaps at stairs are (about 25)"},
    {"lidar/hilti_uzh_run2/hall_level.dxf", 0, 0, 0, 0, "the hall's walls do not close"},
};

class Drawings : public testing::TestWithParam<Counted> {};

TEST_P(Drawings, RoomsAndDoorwaysAreThoseThatAPersonCounts) {
  const Counted& expected = GetParam();
  const fs::path path = kData / expected.path;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
  const CompileResult result = Compile(path.string());
  ASSERT_TRUE(result.graph) << DiagnosticsToText(result.diagnostics.all(), expected.path);
  EXPECT_EQ(result.graph->rooms.size(), expected.rooms);
  EXPECT_EQ(result.graph->doorways.size(), expected.doorways);
  EXPECT_GE(10 * expected.rooms, 9 * expected.drawn_rooms);
  EXPECT_GE(10 * expected.doorways, 9 * expected.drawn_doorways);
}

TEST_P(Drawings, SameBytesEveryTime) {
  const fs::path path = kData / GetParam().path;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
  const CompileResult a = Compile(path.string()), b = Compile(path.string());
  ASSERT_TRUE(a.graph && b.graph);
  EXPECT_EQ(WriteAGraph(*a.graph), WriteAGraph(*b.graph));
}

INSTANTIATE_TEST_SUITE_P(OfOthers, Drawings, testing::ValuesIn(kCounted), [](const auto& drawing) {
  std::string name = fs::path(drawing.param.path).filename().string();
  std::replace_if(name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

}  // namespace
}  // namespace plumb::compiler
