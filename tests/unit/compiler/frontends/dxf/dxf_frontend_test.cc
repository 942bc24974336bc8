#include "compiler/frontends/dxf/dxf_frontend.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <vector>

#include "compiler/compile.h"
#include "tests/support/dxf_text.h"
#include "tests/support/temporary_folder.h"

namespace plumb::compiler {
namespace {

using test::DxfText;

class DxfPlans : public testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& bytes) {
    const std::string path = folder_.path() + "/" + name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  CompileResult CompileText(const DxfText& dxf, const CompileOptions& options = {}) {
    return Compile(Write("plan.dxf", dxf.Str()), options);
  }
  // With a graph, or the diagnostics as failures.
  AGraph GraphOf(const DxfText& dxf, const CompileOptions& options = {}) {
    const CompileResult result = CompileText(dxf, options);
    EXPECT_TRUE(result.graph) << DiagnosticsToText(result.diagnostics.all(), "plan.dxf");
    return result.graph.value_or(AGraph());
  }
  static bool Says(const CompileResult& result, DiagnosticKind kind) {
    const auto& all = result.diagnostics.all();
    return std::any_of(all.begin(), all.end(), [&](const Diagnostic& d) { return d.kind == kind; });
  }

  test::TemporaryFolder folder_;
};

// Two rooms of 3.8 m x 3.6 m and 3.9 m x 3.6 m in walls of 0.2 m and 0.1 m, the wall between them open from y = 1 to y = 1.9.
DxfText TwoRooms(const std::string& layer, double k = 1) {
  DxfText out;
  out.Header("$INSUNITS", 70, k == 1 ? "6" : "4");
  const auto line = [&](double x0, double y0, double x1, double y1) { out.Line(layer, k * x0, k * y0, k * x1, k * y1); };
  line(0, 0, 8.2, 0), line(8.2, 0, 8.2, 4), line(8.2, 4, 0, 4), line(0, 4, 0, 0);
  line(0.2, 0.2, 4.0, 0.2), line(4.0, 0.2, 4.0, 1), line(4.0, 1, 4.1, 1), line(4.1, 1, 4.1, 0.2), line(4.1, 0.2, 8.0, 0.2),
      line(8.0, 0.2, 8.0, 3.8);
  line(8.0, 3.8, 4.1, 3.8), line(4.1, 3.8, 4.1, 1.9), line(4.1, 1.9, 4.0, 1.9), line(4.0, 1.9, 4.0, 3.8), line(4.0, 3.8, 0.2, 3.8),
      line(0.2, 3.8, 0.2, 0.2);
  return out;
}

TEST_F(DxfPlans, DoubleLinesAreWallsAndAGapIsAPassage) {
  const AGraph g = GraphOf(TwoRooms("0"));
  ASSERT_EQ(g.rooms.size(), 2u);
  EXPECT_NEAR(g.rooms[0].area_m2 + g.rooms[1].area_m2, 3.8 * 3.6 + 3.9 * 3.6, 0.01);
  ASSERT_EQ(g.doorways.size(), 1u);
  EXPECT_NEAR(g.doorways[0].width_m, 0.9, 0.002);
  EXPECT_NEAR(g.doorways[0].position.x(), 4.05, 0.002);
  EXPECT_NEAR(g.doorways[0].position.y(), 1.45, 0.002);
  EXPECT_FALSE(g.doorways[0].has_leaf);
  EXPECT_EQ(g.walls.size(), 5u);
}

TEST_F(DxfPlans, BlockOfADoorGivesItsLeafAndHandle) {
  for (const std::string layer : {"A-DOOR", "0"}) {
    DxfText dxf = TwoRooms("A-WALL");
    dxf.DoorBlock("Door_Single").Insert(layer, "Door_Single", 4.0, 1, {{41, "0.9"}, {42, "0.9"}, {50, "90"}});
    const AGraph g = GraphOf(dxf);
    ASSERT_EQ(g.doorways.size(), 1u) << layer;
    EXPECT_TRUE(g.doorways[0].has_leaf);
    EXPECT_FALSE(g.doorways[0].guid.empty());
  }
}

TEST_F(DxfPlans, SwingAmongAllOtherLinesIsADoorAndNoWall) {
  DxfText dxf = TwoRooms("0");
  dxf.Line("0", 4.1, 1, 5.0, 1).Entity("ARC", "0", {{10, "4.1"}, {20, "1"}, {40, "0.9"}, {50, "0"}, {51, "90"}});
  const AGraph g = GraphOf(dxf);
  ASSERT_EQ(g.rooms.size(), 2u);
  ASSERT_EQ(g.doorways.size(), 1u);
  EXPECT_TRUE(g.doorways[0].has_leaf);
}

TEST_F(DxfPlans, DoorOverAWallThatGoesOnIsHosted) {
  DxfText dxf;
  dxf.Header("$INSUNITS", 70, "6").Box("A-WALL", 0, 0, 5, 4).Box("A-WALL", 0.2, 0.2, 4.8, 3.8).DoorBlock("D");
  dxf.Insert("A-DOOR", "D", 2, 0.2, {{41, "0.9"}, {42, "0.9"}});
  const AGraph g = GraphOf(dxf);
  ASSERT_EQ(g.doorways.size(), 1u);
  EXPECT_NEAR(g.doorways[0].position.x(), 2.45, 0.01);
  EXPECT_NEAR(g.doorways[0].position.y(), 0.1, 0.01);
}

TEST_F(DxfPlans, NestedMirroredAndRepeatedBlocksUnfold) {
  DxfText dxf;
  dxf.Header("$INSUNITS", 70, "6").Begin("CELL").Box("0", 0, 0, 3, 3).Box("0", 0.2, 0.2, 2.8, 2.8).End();
  dxf.Begin("ROW").Insert("0", "CELL", 0, 0, {{70, "3"}, {71, "2"}, {44, "2.8"}, {45, "2.8"}}).End();
  dxf.Insert("WALL", "ROW", 20, 5, {{41, "-1"}});
  const AGraph g = GraphOf(dxf);
  ASSERT_EQ(g.rooms.size(), 6u);
  for (const Room& r : g.rooms) {
    EXPECT_NEAR(r.area_m2, 2.6 * 2.6, 0.01);
    EXPECT_LT(r.center.x(), 20);
    EXPECT_GT(r.center.y(), 5);
  }
}

TEST_F(DxfPlans, MillimetresAndStatedUnitGiveTheSamePlan) {
  EXPECT_NEAR(GraphOf(TwoRooms("WALL", 1000)).rooms.at(0).area_m2, GraphOf(TwoRooms("WALL")).rooms.at(0).area_m2, 1e-3);
  CompileOptions options;
  options.drawing.unit = "m";
  DxfText lies = TwoRooms("WALL");
  lies.Header("$INSUNITS", 70, "4");
  EXPECT_TRUE(Says(CompileText(lies), DiagnosticKind::kUnitContradicted));
  EXPECT_FALSE(Says(CompileText(lies, options), DiagnosticKind::kUnitContradicted));
}

// A half round of 3 m inner radius on a straight wall, 0.2 m thick: both outlines closed, with bulges.
TEST_F(DxfPlans, CurvedWallsBoundTheirRoom) {
  DxfText dxf;
  dxf.Header("$INSUNITS", 70, "6");
  dxf.Entity("LWPOLYLINE", "WALL",
             {{90, "4"},
              {70, "1"},
              {10, "-3.2"},
              {20, "-0.2"},
              {10, "3.2"},
              {20, "-0.2"},
              {10, "3.2"},
              {20, "0"},
              {42, "1"},
              {10, "-3.2"},
              {20, "0"}});
  dxf.Entity("LWPOLYLINE", "WALL", {{90, "2"}, {70, "1"}, {10, "-3"}, {20, "0"}, {10, "3"}, {20, "0"}, {42, "1"}});
  const AGraph g = GraphOf(dxf);
  ASSERT_EQ(g.rooms.size(), 1u);
  EXPECT_NEAR(g.rooms[0].area_m2, 0.5 * 3.14159265 * 9, 0.06);
}

// Whatever the unit, which is known only once the arcs are read: a wall of two arcs about (0, -100), its inner face 100 m from there.
TEST_F(DxfPlans, DoubleLinesOfALargeRadiusAreTwoArcs) {
  for (const double k : {1.0, 1000.0}) {
    DxfText dxf;
    dxf.Header("$INSUNITS", 70, k == 1 ? "6" : "4");
    const auto arc = [&](double radius_m, double half_m) {
      const double half_deg = std::asin(half_m / radius_m) * 180 / std::numbers::pi;
      dxf.Entity("ARC", "WALL",
                 {{10, "0"},
                  {20, fmt::format("{}", -100 * k)},
                  {40, fmt::format("{}", radius_m * k)},
                  {50, fmt::format("{}", 90 - half_deg)},
                  {51, fmt::format("{}", 90 + half_deg)}});
      return std::sqrt(radius_m * radius_m - half_m * half_m) - 100;  // its ends' y
    };
    for (const double offset_m : {0.0, 0.3}) {
      const double x = 10 + offset_m, y = arc(100 + offset_m, x), low = -8 - offset_m;
      dxf.Line("WALL", k * x, k * y, k * x, k * low)
          .Line("WALL", -k * x, k * y, -k * x, k * low)
          .Line("WALL", k * x, k * low, -k * x, k * low);
    }
    const AGraph g = GraphOf(dxf);
    ASSERT_EQ(g.rooms.size(), 1u);
    EXPECT_EQ(g.surfaces.size(), 12u);
    std::vector<double> radii_m;
    for (const Surface& s : g.surfaces) {
      if (s.arc) radii_m.push_back(s.arc->radius_m);
    }
    std::sort(radii_m.begin(), radii_m.end());
    ASSERT_EQ(radii_m.size(), 2u);
    EXPECT_NEAR(radii_m[0], 100, 0.001);
    EXPECT_NEAR(radii_m[1], 100.3, 0.001);
  }
}

TEST_F(DxfPlans, HatchedWallsAreWallsHoweverThick) {
  DxfText dxf;
  dxf.Header("$INSUNITS", 70, "6");
  for (const auto& [x0, y0, x1, y1] : std::vector<std::array<double, 4>>{{0, 0, 8, 1}, {0, 5, 8, 6}, {0, 1, 1, 5}, {7, 1, 8, 5}}) {
    const auto n = [](double v) { return fmt::format("{}", v); };
    dxf.Entity("SOLID", "WALL", {{10, n(x0)}, {20, n(y0)}, {11, n(x1)}, {21, n(y0)}, {12, n(x0)}, {22, n(y1)}, {13, n(x1)}, {23, n(y1)}});
  }
  CompileOptions options;
  options.drawing.unit = "m";
  const AGraph g = GraphOf(dxf, options);
  ASSERT_EQ(g.rooms.size(), 1u);
  EXPECT_NEAR(g.rooms[0].area_m2, 24, 0.01);
}

// Neither jambs nor corners have a line across: ends of walls are closed where both lines end beside each other.
TEST_F(DxfPlans, OpenEndsOfWallsAreClosed) {
  DxfText dxf;
  dxf.Header("$INSUNITS", 70, "6");
  const auto wall = [&](double x0, double x1, double y0, double y1) { dxf.Line("WALL", x0, y0, x1, y0).Line("WALL", x0, y1, x1, y1); };
  wall(0, 5, 0, 0.2);
  wall(0, 2, 3.8, 4), wall(2.9, 5, 3.8, 4);
  for (const double x : {0.0, 4.8}) dxf.Line("WALL", x, 0.2, x, 3.8).Line("WALL", x + 0.2, 0.2, x + 0.2, 3.8);
  const AGraph g = GraphOf(dxf);
  ASSERT_EQ(g.rooms.size(), 1u);
  EXPECT_NEAR(g.rooms[0].area_m2, 4.6 * 3.6, 0.01);
  ASSERT_EQ(g.doorways.size(), 1u);
  EXPECT_NEAR(g.doorways[0].width_m, 0.9, 0.002);
}

TEST_F(DxfPlans, CoordinatesOfACountryKeepTheirPrecision) {
  DxfText far;
  far.Header("$INSUNITS", 70, "6")
      .Begin("HOUSE")
      .Box("0", 0, 0, 5, 4)
      .Box("0", 0.2, 0.2, 4.8, 3.8)
      .End()
      .Insert("WALL", "HOUSE", 3456789.25, 5432100.5);
  const AGraph g = GraphOf(far);
  ASSERT_EQ(g.rooms.size(), 1u);
  EXPECT_NEAR(g.rooms[0].area_m2, 4.6 * 3.6, 1e-3);
  EXPECT_NEAR(g.rooms[0].center.x(), 3456791.75, 1e-3);
  EXPECT_NEAR(g.rooms[0].center.y(), 5432102.5, 1e-3);
}

TEST_F(DxfPlans, TextNamesItsRoom) {
  const AGraph g = GraphOf(TwoRooms("WALL").Text("TEXT", "B\\U+00FCro", 1, 2).Text("TEXT", "13.7 m2", 1, 1.5));
  ASSERT_EQ(g.rooms.size(), 2u);
  EXPECT_TRUE(g.rooms[0].name == "Büro" || g.rooms[1].name == "Büro") << g.rooms[0].name << ", " << g.rooms[1].name;
}

TEST_F(DxfPlans, SingleLinesAreGivenAThickness) {
  DxfText dxf;
  dxf.Header("$INSUNITS", 70, "6").Line("0", 0, 0, 5, 0).Line("0", 5, 0, 5, 4).Line("0", 5, 4, 0, 4).Line("0", 0, 4, 0, 0);
  CompileOptions options;
  options.drawing.plan.mass.single_line_thickness_m = 0.2;
  const AGraph g = GraphOf(dxf, options);
  ASSERT_EQ(g.rooms.size(), 1u);
  EXPECT_NEAR(g.rooms[0].area_m2, 4.8 * 3.8, 0.01);
}

TEST_F(DxfPlans, PlansSideBySideAreStoreysOrSheets) {
  DxfText dxf;
  dxf.Header("$INSUNITS", 70, "6");
  for (const double x : {0.0, 9.0}) dxf.Box("WALL", x, 0, x + 5, 4).Box("WALL", x + 0.2, 0.2, x + 4.8, 3.8);
  const AGraph both = GraphOf(dxf);
  ASSERT_EQ(both.storeys.size(), 2u);
  ASSERT_EQ(both.rooms.size(), 2u);
  EXPECT_NEAR(both.rooms[0].center.x(), both.rooms[1].center.x(), 1e-3);
  CompileOptions options;
  options.drawing.sheet = 2;
  EXPECT_EQ(GraphOf(dxf, options).storeys.size(), 1u);
}

TEST_F(DxfPlans, StoreysOfSeveralFilesAreOnePlan) {
  const std::string path = Write("plan.dxf", TwoRooms("WALL").Str());
  const CompileResult result = CompileStoreys({{"OG", path, 3.0}, {"EG", path, 0.0}});
  ASSERT_TRUE(result.graph);
  ASSERT_EQ(result.graph->storeys.size(), 2u);
  EXPECT_EQ(result.graph->storeys[0].name, "EG");
  EXPECT_NEAR(result.graph->storeys[1].elevation_m, 3.0, 1e-9);
  EXPECT_EQ(result.graph->rooms.size(), 4u);
  EXPECT_FALSE(CompileStoreys({{"EG", "nowhere.dxf", 0.0}}).graph);
}

TEST_F(DxfPlans, OtherFilesUnderTheNameAreRefused) {
  for (const char* bytes : {"\xff\xd8\xff\xe0\x10JFIF", "AC1032 a drawing", "  0\nSECTION\n  2\nENTITIES\nprose\n", ""}) {
    const CompileResult result = Compile(Write("plan.dxf", bytes));
    EXPECT_FALSE(result.graph) << bytes;
    EXPECT_TRUE(result.diagnostics.has_errors()) << bytes;
    EXPECT_FALSE(result.has_internal_error()) << bytes;
  }
}

TEST_F(DxfPlans, BlocksThatMultiplyAreBounded) {
  DxfText dxf;
  dxf.Begin("B0").Line("0", 0, 0, 1, 0).End();
  for (int i = 1; i < 12; ++i) {
    dxf.Begin("B" + std::to_string(i)).Insert("0", "B" + std::to_string(i - 1), 0, 0, {{70, "30"}, {71, "30"}, {44, "2"}, {45, "2"}}).End();
  }
  dxf.Insert("0", "B11", 0, 0);
  DrawingFileOptions options;
  options.max_paths = 10'000;
  CompileOptions compile;
  compile.drawing = options;
  const CompileResult result = CompileText(dxf, compile);
  EXPECT_FALSE(result.graph);
  EXPECT_TRUE(Says(result, DiagnosticKind::kPlanTooComplex));
}

}  // namespace
}  // namespace plumb::compiler
