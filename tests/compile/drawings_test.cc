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
#include "tests/compile/by_eye.h"

namespace plumb::compiler {
namespace {

namespace fs = std::filesystem;

const fs::path kData = fs::path(PLUMB_SOURCE_DIR) / ".." / "shared" / "data";

// Plans whose own descriptions give the counts.
struct Counted {
  const char* path;
  size_t rooms, doorways;
};
void PrintTo(const Counted& c, std::ostream* out) { *out << c.path; }

constexpr Counted kCounted[] = {
    {"lidar/fr079/asbuilt.dxf", 18, 23},
    {"lidar/fr079/asbuilt.svg", 18, 23},
    {"lidar/fr079/plan.dxf", 16, 15},
    {"lidar/hilti_uzh_run2/hall_level.dxf", 0, 0},  // the hall's walls do not close
};

constexpr double kInch_m = 0.0254;

// Read on prints of the drawings themselves.
const test::ByEye kSeen[] = {
    {"plans/dxf/benhudson_floorplan.dxf",
     kInch_m,
     {{-350, 140}, {-350, 62}, {-420, 62}, {-370, -10}, {-271, -30}, {-230, -30}, {-220, 180}, {-215, 120}, {-240, 45}, {-130, 50}},
     {{-354, 77}, {-269, 77}, {-411, 47}, {-291, 27}, {-271, 11}, {-228, 8}, {-225, 77}, {-206, 147}, {-206, 56}, {4, -29}},
     1,
     0,
     1,
     0,
     "the laundry between two walls that end side by side has no jamb across its mouth: it is taken for a part of the hall"},
    {"plans/dxf/bjnortier_floorplan.dxf",
     kInch_m,
     {{-560, 260},
      {-435, 300},
      {-360, 300},
      {-435, 240},
      {-355, 240},
      {-435, 183},
      {-595, 150},
      {-535, 150},
      {-560, 60},
      {-410, 50},
      {-323, 40},
      {-323, 108},
      {-200, 230},
      {-180, 90},
      {-130, 90},
      {-90, -80}},
     {{-561, 344},
      {-477, 292},
      {-388, 293},
      {-433, 272},
      {-497, 171},
      {-343, 171},
      {-433, 171},
      {-594, 127},
      {-520, 149},
      {-499, 127},
      {-458, 127},
      {-337, 41},
      {-309, 109},
      {-247, 42},
      {-158, 107},
      {-92, 107},
      {-67, 42},
      {44, 261},
      {-86, -214}}},
    {"plans/dxf/roomsize_two-rooms.dxf", 1, {{1.2, -0.2}, {5.3, -0.1}}, {{2.3, -2.45}}},
};

class SeenDrawings : public testing::TestWithParam<test::ByEye> {};

TEST_P(SeenDrawings, HaveTheRoomsAndDoorwaysThatAPersonSees) {
  const test::ByEye& expected = GetParam();
  const fs::path path = kData / expected.path;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
  const CompileResult result = Compile(path.string());
  ASSERT_TRUE(result.graph) << DiagnosticsToText(result.diagnostics.all(), expected.path);
  const test::Compared compared = test::Compare(expected, *result.graph);
  EXPECT_EQ(compared.rooms_missed, expected.rooms_missed) << compared.text;
  EXPECT_EQ(compared.rooms_added, expected.rooms_added) << compared.text;
  EXPECT_EQ(compared.doorways_missed, expected.doorways_missed) << compared.text;
  EXPECT_EQ(compared.doorways_added, expected.doorways_added) << compared.text;
}

TEST_P(SeenDrawings, GiveTheSameBytesEveryTime) {
  const fs::path path = kData / GetParam().path;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
  const CompileResult a = Compile(path.string()), b = Compile(path.string());
  ASSERT_TRUE(a.graph && b.graph);
  EXPECT_EQ(WriteAGraph(*a.graph), WriteAGraph(*b.graph));
}

template <class Param>
std::string NameOf(const testing::TestParamInfo<Param>& drawing) {
  std::string name = fs::path(drawing.param.path).filename().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(OfOthers, SeenDrawings, testing::ValuesIn(kSeen), NameOf<test::ByEye>);

// Where the drawing of the CMU floor has the numbers of its rooms: each number is one room. (Read off the file's own texts; not its doors,
// of which a person counts 95 and we find about 76, with some 25 false ones in toilet stalls and at stairs.)
const test::ByEye kNumbered = {
    "plans/svg/newell-simon_2011_GIS-1.svg",
    1,
    {{48.7, -19.5}, {52.6, -31.7}, {71.0, -31.9}, {29.5, -32.1}, {25.9, -41.1}, {40.9, -28.2}, {61.2, -42.1}, {24.1, -22.4}, {25.9, -50.3},
     {23.9, -10.5}, {69.4, -22.2}, {39.1, -10.8}, {33.1, -19.9}, {55.2, -47.0}, {44.3, -48.0}, {66.6, -17.8}, {18.9, -16.6}, {36.0, -45.3},
     {61.3, -38.7}, {75.2, -15.5}, {66.7, -11.7}, {72.2, -25.0}, {32.4, -38.6}, {34.9, -52.5}, {35.6, -35.1}, {70.5, -38.7}, {41.9, -38.7},
     {40.6, -35.0}, {77.1, -51.1}, {39.5, -52.5}, {74.1, -51.6}, {61.6, -52.6}, {54.2, -38.6}, {29.1, -16.5}, {51.0, -52.4}, {50.7, -38.7},
     {28.9, -20.1}, {67.1, -52.7}, {25.5, -26.0}, {38.3, -38.8}, {29.2, -26.0}, {39.7, -44.3}, {31.2, -52.5}, {21.6, -26.2}, {32.8, -44.2},
     {32.8, -47.1}, {67.0, -38.7}, {76.9, -38.5}, {76.9, -20.6}, {76.1, -10.5}, {76.9, -41.9}, {38.6, -48.1}, {73.9, -19.9}, {43.8, -32.0},
     {54.7, -52.5}, {46.1, -52.5}, {71.0, -52.4}, {46.4, -44.2}, {72.7, -10.8}, {23.2, -19.0}, {50.6, -44.2}, {50.6, -47.0}, {65.3, -49.1},
     {57.7, -52.4}, {43.3, -52.4}, {65.3, -44.8}, {77.4, -45.6}, {18.1, -26.4}, {36.4, -25.7}, {23.9, -16.3}, {76.9, -25.3}, {41.1, -31.6},
     {48.2, -38.7}, {38.6, -31.1}, {27.3, -13.1}, {35.6, -22.7}, {38.2, -32.9}, {43.8, -29.8}, {52.5, -55.3}, {74.8, -12.1}, {48.2, -52.5},
     {64.4, -52.9}, {37.0, -36.2}, {22.1, -15.2}, {22.0, -20.0}, {40.9, -33.3}, {76.4, -12.2}, {36.8, -31.2}, {36.8, -34.1}, {48.0, -32.9},
     {37.1, -34.8}},
    {},
    13,
    26,
    0,
    0,
    "1150, 1127, 1211, 1904 and the spiral stair 1903 are open to the outside or the hall between single lines; 1603 has no wall to 1600; "
    "1109B, "
    "1301, 1303, 1401A and 1900B are closets without a drawn door; rooms without a number are flights of stairs, toilet stalls and shafts"};

TEST(NumberedDrawing, HasARoomForEachNumberThatItIsDrawnWith) {
  const fs::path path = kData / kNumbered.path;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
  const CompileResult result = Compile(path.string());
  ASSERT_TRUE(result.graph) << DiagnosticsToText(result.diagnostics.all(), kNumbered.path);
  const test::Compared compared = test::Compare(kNumbered, *result.graph);
  EXPECT_LE(compared.rooms_missed, kNumbered.rooms_missed) << compared.text;
  EXPECT_LE(compared.rooms_added, kNumbered.rooms_added) << compared.text;
}

class Drawings : public testing::TestWithParam<Counted> {};

TEST_P(Drawings, HaveTheRoomsAndDoorwaysOfTheirDescriptions) {
  const Counted& expected = GetParam();
  const fs::path path = kData / expected.path;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
  const CompileResult result = Compile(path.string());
  ASSERT_TRUE(result.graph) << DiagnosticsToText(result.diagnostics.all(), expected.path);
  EXPECT_EQ(result.graph->rooms.size(), expected.rooms);
  EXPECT_EQ(result.graph->doorways.size(), expected.doorways);
}

TEST_P(Drawings, SameBytesEveryTime) {
  const fs::path path = kData / GetParam().path;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
  const CompileResult a = Compile(path.string()), b = Compile(path.string());
  ASSERT_TRUE(a.graph && b.graph);
  EXPECT_EQ(WriteAGraph(*a.graph), WriteAGraph(*b.graph));
}

INSTANTIATE_TEST_SUITE_P(OfOthers, Drawings, testing::ValuesIn(kCounted), NameOf<Counted>);

}  // namespace
}  // namespace plumb::compiler
