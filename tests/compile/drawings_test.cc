// Drawings as a whole: those of others against rooms and doorways counted by eye, ours against the same plan as IFC.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <ostream>
#include <set>
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

class SiteOffice : public testing::Test {
 protected:
  static AGraph Of(const char* name) {
    CompileOptions options;
    options.drawing.plan.heights.door_m = 2.1;
    const CompileResult result = Compile((fs::path(PLUMB_SOURCE_DIR) / "plans" / "site_office" / name).string(), options);
    EXPECT_TRUE(result.graph) << DiagnosticsToText(result.diagnostics.all(), name);
    return result.graph.value_or(AGraph());
  }
  const AGraph ifc_ = Of("plan.ifc"), dxf_ = Of("plan.dxf");
};

TEST_F(SiteOffice, DrawingHasTheRoomsOfTheModel) {
  ASSERT_EQ(dxf_.rooms.size(), ifc_.rooms.size());
  for (const Room& room : ifc_.rooms) {
    const auto same = std::find_if(dxf_.rooms.begin(), dxf_.rooms.end(), [&](const Room& r) { return r.name == room.name; });
    ASSERT_NE(same, dxf_.rooms.end()) << room.name;
    EXPECT_NEAR(same->area_m2, room.area_m2, 0.01) << room.name;
    EXPECT_LT((same->center - room.center).norm(), 0.01) << room.name;
  }
}

TEST_F(SiteOffice, DrawingHasTheDoorwaysOfTheModel) {
  ASSERT_EQ(dxf_.doorways.size(), ifc_.doorways.size());
  EXPECT_EQ(dxf_.windows.size(), ifc_.windows.size());
  const auto names = [](const AGraph& g, const Doorway& d) {
    std::set<std::string> out;
    for (const RoomId id : {d.room_a, d.room_b}) out.insert(id.valid() ? g.rooms[id.index()].name : "outside");
    return out;
  };
  for (const Doorway& d : ifc_.doorways) {
    const auto same = std::find_if(dxf_.doorways.begin(), dxf_.doorways.end(), [&](const Doorway& o) { return (o.position - d.position).norm() < 0.01; });
    ASSERT_NE(same, dxf_.doorways.end()) << d.name;
    EXPECT_NEAR(same->width_m, d.width_m, 0.01) << d.name;
    EXPECT_EQ(same->has_leaf, d.has_leaf) << d.name;
    EXPECT_EQ(names(dxf_, *same), names(ifc_, d)) << d.name;
  }
}

// A drawing does not say where one wall ends and the next one goes on in its line: surfaces are compared as lines, piece by piece.
TEST_F(SiteOffice, DrawingHasTheWallSurfacesOfTheModelWithinACentimetre) {
  EXPECT_EQ(dxf_.walls.size(), ifc_.walls.size());
  const auto covered = [](const Surface& s, const AGraph& by) {
    for (int i = 0; i <= 20; ++i) {
      const Eigen::Vector2d p = s.start + (0.02 + 0.96 * i / 20) * (s.end - s.start);
      const bool found = std::any_of(by.surfaces.begin(), by.surfaces.end(), [&](const Surface& o) {
        const Eigen::Vector2d u = (o.end - o.start).normalized(), q = p - o.start;
        const double along = u.dot(q), across = u.x() * q.y() - u.y() * q.x();
        return o.normal.dot(s.normal) > 0.9999 && std::abs(across) < 0.01 && along > -0.01 && along < (o.end - o.start).norm() + 0.01;
      });
      if (!found) return false;
    }
    return true;
  };
  for (const Surface& s : ifc_.surfaces) EXPECT_TRUE(covered(s, dxf_)) << s.start.transpose() << " to " << s.end.transpose();
  for (const Surface& s : dxf_.surfaces) EXPECT_TRUE(covered(s, ifc_)) << s.start.transpose() << " to " << s.end.transpose();
}

}  // namespace
}  // namespace plumb::compiler
