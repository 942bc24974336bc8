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

// Where the drawing of the CMU floor has the numbers of its rooms: each number is one room. Doorways as read on the drawing with the
// compiled plan laid over it, where the two agree at the plan's coordinates: a pair of jambs with a leaf, or with nothing but the rooms'
// outlines between them; two leaves are one, and so are the doors of lifts. Gaps within one numbered room (stalls, windbreaks, alcoves) are
// no doorways, nor are the panels of a folding partition.
const test::ByEye kNumbered = {
    "plans/svg/newell-simon_2011_GIS-1.svg",
    1,
    {{48.6, -19.4}, {52.5, -31.6}, {70.8, -31.8}, {29.5, -31.9}, {25.9, -41.0}, {40.8, -28.1}, {61.0, -42.1}, {24.0, -22.3}, {25.9, -50.2},
     {23.9, -10.3}, {69.2, -22.1}, {39.0, -10.6}, {33.0, -19.8}, {55.0, -47.0}, {44.2, -47.9}, {66.4, -17.7}, {18.9, -16.4}, {35.9, -45.2},
     {70.4, -46.5}, {59.9, -46.5}, {61.1, -38.7}, {75.0, -15.4}, {66.6, -11.6}, {72.0, -25.0}, {32.4, -38.5}, {34.8, -52.5}, {35.5, -35.1},
     {70.3, -38.6}, {41.8, -38.7}, {42.9, -34.3}, {76.8, -51.2}, {39.4, -52.5}, {73.9, -51.6}, {61.4, -52.6}, {54.0, -38.5}, {29.1, -16.4},
     {50.8, -52.4}, {50.6, -38.6}, {28.9, -19.9}, {66.9, -52.8}, {25.5, -25.9}, {38.2, -38.7}, {29.1, -25.9}, {39.6, -44.2}, {31.2, -52.4},
     {21.6, -26.0}, {32.7, -44.2}, {32.7, -47.0}, {66.8, -38.7}, {76.6, -38.5}, {76.7, -20.5}, {75.9, -10.4}, {76.6, -41.9}, {38.5, -48.1},
     {73.6, -19.8}, {43.7, -31.9}, {54.6, -52.5}, {46.0, -52.5}, {70.8, -52.5}, {46.2, -44.1}, {72.5, -10.6}, {23.2, -18.8}, {50.5, -44.1},
     {50.5, -47.0}, {63.7, -49.1}, {66.5, -49.1}, {57.5, -52.5}, {43.1, -52.4}, {63.7, -44.8}, {66.5, -44.8}, {77.1, -45.6}, {18.1, -26.2},
     {36.3, -25.6}, {23.8, -16.1}, {76.7, -25.2}, {41.0, -31.5}, {48.1, -38.6}, {38.6, -31.0}, {27.3, -13.0}, {35.5, -22.6}, {38.1, -32.8},
     {43.7, -29.7}, {52.3, -55.3}, {74.6, -12.0}, {48.0, -52.5}, {64.2, -52.9}, {36.9, -36.2}, {22.1, -15.1}, {22.0, -19.9}, {40.8, -33.3},
     {76.2, -12.0}, {36.8, -31.1}, {36.8, -34.1}, {47.9, -32.8}, {37.0, -34.7}},
    {{43.5, -42.7}, {53.2, -42.7}, {61.6, -42.7}, {68.6, -42.7}, {31.1, -50.3}, {36.3, -50.3}, {41.1, -50.3}, {42.9, -50.3}, {46.4, -50.3},
     {56.2, -40.8}, {66.0, -40.8}, {68.8, -40.8}, {34.3, -25.2}, {49.2, -50.3}, {55.5, -50.3}, {58.3, -50.3}, {61.7, -50.3}, {22.3, -12.4},
     {69.8, -12.1}, {69.8, -16.6}, {70.7, -23.1}, {74.3, -23.1}, {30.3, -40.7}, {34.4, -40.7}, {39.1, -40.7}, {19.2, -20.4}, {67.9, -49.4},
     {67.9, -44.8}, {62.3, -49.4}, {62.3, -44.8}, {71.7, -13.3}, {71.7, -17.8}, {30.5, -49.0}, {48.4, -49.1}, {72.9, -49.0}, {57.4, -49.4},
     {27.0, -17.1}, {27.0, -18.7}, {65.2, -14.3}, {74.9, -40.8}, {74.9, -39.6}, {71.8, -11.4}, {74.9, -11.4}, {34.8, -47.8}, {34.8, -43.4},
     {52.6, -47.8}, {52.6, -44.8}, {75.5, -22.2}, {51.6, -40.8}, {38.4, -30.0}, {40.6, -30.0}, {68.8, -50.3}, {70.0, -50.3}, {40.0, -49.8},
     {20.4, -24.6}, {47.3, -39.7}, {75.7, -45.6}, {23.5, -14.6}, {62.9, -29.6}, {74.3, -21.2}, {26.4, -24.2}, {28.5, -24.2}, {16.6, -23.2},
     {78.5, -45.6}, {19.5, -26.2}, {61.4, -26.9}, {44.1, -45.0}, {43.7, -35.6}, {77.5, -47.7}, {29.8, -23.1}, {42.4, -43.4}, {34.4, -28.8},
     {34.4, -34.9}, {29.2, -10.8}, {38.3, -25.2}, {30.0, -11.3}, {32.0, -42.1}, {25.6, -19.8}, {37.1, -26.6}, {36.6, -32.6}, {73.7, -12.1},
     {21.4, -19.9}, {21.4, -15.1}, {21.6, -39.7}, {21.6, -51.5}, {74.1, -36.3}, {76.6, -36.4}, {78.1, -29.0}, {36.6, -31.1}, {36.6, -34.1},
     {62.9, -32.8}, {63.6, -40.8}, {75.4, -12.1}, {77.9, -22.2}},
    6,
    5,
    4,
    7,
    "1150 is open to the outside between single lines; 1211B is open to 1211; the shafts 1401A and 1900B are taken for walls; of the "
    "stairs 1903 "
    "and 1904 flights are found; the others without a number are shafts and a light well. The doorway "
    "at 75.5, -22.2 is found 0.3 m off, those at 70.7, -23.1, at 75.4, -12.1 and at 77.9, -22.2 are not found; gaps at stairs and beside "
    "the door of the screen to 1120 are false"};

TEST(NumberedDrawing, HasTheRoomsAndDoorwaysThatAPersonSees) {
  const fs::path path = kData / kNumbered.path;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
  const CompileResult result = Compile(path.string());
  ASSERT_TRUE(result.graph) << DiagnosticsToText(result.diagnostics.all(), kNumbered.path);
  const test::Compared compared = test::Compare(kNumbered, *result.graph);
  EXPECT_LE(compared.rooms_missed, kNumbered.rooms_missed) << compared.text;
  EXPECT_LE(compared.rooms_added, kNumbered.rooms_added) << compared.text;
  EXPECT_LE(compared.doorways_missed, kNumbered.doorways_missed) << compared.text;
  EXPECT_LE(compared.doorways_added, kNumbered.doorways_added) << compared.text;
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
