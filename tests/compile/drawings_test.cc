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
     {{-560, 260}, {-435, 300}, {-360, 300}, {-435, 240}, {-355, 240}, {-435, 183}, {-595, 150}, {-535, 150},
      {-560, 60},  {-410, 50},  {-323, 40},  {-323, 108}, {-200, 230}, {-180, 90},  {-130, 90},  {-90, -80}},
     {{-561, 344}, {-477, 292}, {-388, 293}, {-433, 272}, {-497, 171}, {-343, 171}, {-433, 171}, {-594, 127}, {-520, 149}, {-499, 127},
      {-458, 127}, {-337, 41},  {-309, 109}, {-247, 42},  {-158, 107}, {-92, 107},  {-67, 42},   {44, 261},   {-86, -214}}},
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
  std::replace_if(name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(OfOthers, SeenDrawings, testing::ValuesIn(kSeen), NameOf<test::ByEye>);

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
