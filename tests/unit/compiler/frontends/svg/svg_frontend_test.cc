// SVG drawings of the kinds that plans come in, each small enough to be checked by hand.
#include "compiler/frontends/svg/svg_frontend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "compiler/compile.h"
#include "schema/files.h"
#include "tests/support/temporary_folder.h"

namespace plumb::compiler {
namespace {

CompileResult CompileText(const std::string& text, const CompileOptions& options = {}) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() + "/plan.svg";
  EXPECT_TRUE(WriteFileAtomically(path, std::string_view(text)));
  return Compile(path, options);
}

bool Says(const CompileResult& result, DiagnosticKind kind) {
  const auto& all = result.diagnostics.all();
  return std::any_of(all.begin(), all.end(), [&](const Diagnostic& d) { return d.kind == kind; });
}

std::set<std::string> RoomNames(const AGraph& graph) {
  std::set<std::string> out;
  for (const Room& room : graph.rooms) out.insert(room.name);
  return out;
}

std::string Text(const CompileResult& result) { return DiagnosticsToText(result.diagnostics.all(), "plan.svg", 100); }

// A flat of 8 m by 6 m in CubiCasa's groups, a pixel a centimetre: kitchen and hall on the left, a living room on the right. Walls are 20
// cm outside and 10 cm inside; the balcony's space has no walls.
constexpr const char* kFlat = R"svg(<?xml version="1.0"?>
<svg xmlns="http://www.w3.org/2000/svg" width="1000" height="800" viewBox="0 0 1000 800">
<g id="Model" class="Model v1-1"><g class="Floor"><g id="Floor-1" class="Floorplan Floor-1">
 <g id="Wall" class="Wall External" fill="#000" stroke="#000"><polygon points="100,100 900,100 900,120 100,120 "/>
  <g id="Window" class="Window Regular" fill="#fff"><polygon points="600,100 760,100 760,120 600,120 "/>
   <g id="Panel" class="Panel"><polygon points="600,100 680,100 680,120 600,120 "/></g></g></g>
 <g id="Wall" class="Wall External" fill="#000" stroke="#000"><polygon points="100,680 900,680 900,700 100,700 "/>
  <g id="Door" class="Door Swing Opposite" fill="#fff"><polygon points="180,680 280,680 280,700 180,700 "/>
   <g id="Threshold" class="Threshold"><polygon points="180,680 280,680 280,700 180,700 "/></g>
   <g id="Panel" class="Panel"><path d="M180,680 L180,580 Q280,580 280,680 "/></g></g></g>
 <g id="Wall" class="Wall External" fill="#000" stroke="#000"><polygon points="100,100 120,100 120,700 100,700 "/>
  <g id="Window" class="Window Regular" fill="#fff"><polygon points="100,200 120,200 120,320 100,320 "/></g></g>
 <g id="Wall" class="Wall External" fill="#000" stroke="#000"><polygon points="880,100 900,100 900,700 880,700 "/></g>
 <g id="Wall" class="Wall" fill="#000" stroke="#000"><polygon points="420,120 430,120 430,680 420,680 "/>
  <g id="Door" class="Door Swing Beside" fill="#fff"><polygon points="420,500 430,500 430,580 420,580 "/>
   <g id="Panel" class="Panel"><path d="M430,500 L510,500 Q510,580 430,580 "/></g></g></g>
 <g id="Wall" class="Wall" fill="#000" stroke="#000"><polygon points="120,400 420,400 420,410 120,410 "/>
  <g id="Door" class="Door None Beside" fill="#fff"><polygon points="300,400 380,400 380,410 300,410 "/></g></g>
 <g class="Space Kitchen" fill="#eee" stroke="none"><polygon points="120,120 420,120 420,400 120,400 "/></g>
 <g class="Space Entry Lobby" fill="#eee" stroke="none"><polygon points="120,410 420,410 420,680 120,680 "/></g>
 <g class="Space LivingRoom" fill="#eee" stroke="none"><polygon points="430,120 880,120 880,680 430,680 "/>
  <g class="NameLabel" transform="matrix(1,0,0,1,620,420)"><text font-size="20">OH</text></g></g>
 <g class="FixedFurnitureSet"><g class="FixedFurniture BaseCabinet"><g class="BoundaryPolygon"><polygon points="120,120 420,120 420,180 120,180" fill="none" stroke="#000"/></g></g></g>
 <g class="Dimension" style="display: none;"><path d="M0 0H1000" stroke="#000"/></g>
</g></g></g></svg>
)svg";

TEST(SvgFrontend, ReadsCubiCasaGroups) {
  CompileOptions options;
  options.drawing.scale_m = 0.01;
  const CompileResult result = CompileText(kFlat, options);
  ASSERT_TRUE(result.graph) << Text(result);
  const AGraph& graph = *result.graph;
  EXPECT_EQ(RoomNames(graph), (std::set<std::string>{"Kitchen", "Entry", "OH"})) << Text(result);
  EXPECT_EQ(graph.doorways.size(), 3u) << Text(result);
  EXPECT_EQ(graph.windows.size(), 2u) << Text(result);
  for (const Room& room : graph.rooms) {
    if (room.name == "Kitchen") {
      EXPECT_NEAR(room.area_m2, 3.0 * 2.8, 0.02);
    }
    if (room.name == "OH") {
      EXPECT_NEAR(room.area_m2, 4.5 * 5.6, 0.02);
    }
  }
}

TEST(SvgFrontend, GuessesTheScaleByDoorsAndSaysSo) {
  const CompileResult result = CompileText(kFlat);
  ASSERT_TRUE(result.graph) << Text(result);
  EXPECT_TRUE(Says(result, DiagnosticKind::kScaleGuessed));
  EXPECT_EQ(result.graph->rooms.size(), 3u) << Text(result);
}

TEST(SvgFrontend, SaysThatAPageContradictsItsWalls) {
  std::string text = kFlat;
  text.replace(text.find("width=\"1000\""), 12, "width=\"100mm\"");
  const CompileResult result = CompileText(text);
  ASSERT_TRUE(result.graph) << Text(result);
  EXPECT_TRUE(Says(result, DiagnosticKind::kUnitContradicted));
  const auto kitchen =
      std::find_if(result.graph->rooms.begin(), result.graph->rooms.end(), [](const Room& r) { return r.name == "Kitchen"; });
  ASSERT_NE(kitchen, result.graph->rooms.end());
  EXPECT_NEAR(kitchen->area_m2, 8.4, 0.02) << "1:100 of a page of 100 mm";
}

// Two rooms of 4 m by 3 m in outlines of one pen, a gap of 0.9 m between them; the drawing's unit is stated by the page.
std::string TwoRooms(const std::string& page, const std::string& group) {
  return "<svg xmlns='http://www.w3.org/2000/svg' " + page + ">" + group +
         "<rect x='0' y='0' width='8500' height='3400' fill='none' stroke='black'/>"
         "<path fill='none' stroke='black' d='M200,200 h4000 v1000 h100 V200 H8300 v3000 H4300 v-1100 h-100 v1100 H200 z'/>"
         "<text x='2000' y='1500' font-size='200'>A</text><text x='6000' y='1500' font-size='200'>B</text></g></svg>";
}

TEST(SvgFrontend, ReadsPlainOutlines) {
  const CompileResult result = CompileText(TwoRooms("width='8.5m' height='3.4m' viewBox='0 0 8500 3400'", "<g>"));
  ASSERT_TRUE(result.graph) << Text(result);
  EXPECT_EQ(RoomNames(*result.graph), (std::set<std::string>{"A", "B"})) << Text(result);
  ASSERT_EQ(result.graph->doorways.size(), 1u) << Text(result);
  EXPECT_NEAR(result.graph->doorways[0].width_m, 0.9, 0.01);
  EXPECT_FALSE(Says(result, DiagnosticKind::kScaleGuessed));
}

TEST(SvgFrontend, ReadsInkscapeLayers) {
  const std::string text = TwoRooms("viewBox='0 0 8500 3400'",
                                    "<g inkscape:groupmode='layer' inkscape:label='M\xc3\xb6"
                                    "bel' id='layer1'><path stroke='black' d='M1000 200V3200'/></g>"
                                    "<g inkscape:groupmode='layer' inkscape:label='W\xc3\xa4nde' id='layer2'>");
  CompileOptions options;
  options.unit = "mm";
  const CompileResult result = CompileText(text, options);
  ASSERT_TRUE(result.graph) << Text(result);
  EXPECT_EQ(result.graph->rooms.size(), 2u) << Text(result);
}

TEST(SvgFrontend, ReadsIdsThatIllustratorEscapes) {
  const std::string text = TwoRooms("width='8500mm' viewBox='0 0 8500 3400'",
                                    "<g id='Furniture_x5F_new_1_'><path stroke='black' d='M1000 200V3200'/></g><g id='_x31_2_x5F_Walls'>");
  const CompileResult result = CompileText(text);
  ASSERT_TRUE(result.graph) << Text(result);
  EXPECT_EQ(result.graph->rooms.size(), 2u) << Text(result);
}

TEST(SvgFrontend, TakesThickStrokesForWallsAmongThinOnes) {
  const CompileResult result = CompileText(
      "<svg xmlns='http://www.w3.org/2000/svg' width='8m' viewBox='0 0 800 400'><g fill='none' stroke='black' stroke-width='20'>"
      "<path d='M10,10H790V390H10Z'/><path d='M400,10V150M400,240V390'/></g>"
      "<g fill='none' stroke='gray' stroke-width='1'><path d='M400,150 H490 A90 90 0 0 1 400,240'/><path d='M600,20V380M500 "
      "50H700V120H500Z'/></g></svg>");
  ASSERT_TRUE(result.graph) << Text(result);
  ASSERT_EQ(result.graph->rooms.size(), 2u) << Text(result);
  EXPECT_EQ(result.graph->doorways.size(), 1u) << Text(result);
  for (const Room& room : result.graph->rooms) EXPECT_NEAR(room.area_m2, 3.7 * 3.6, 0.02);
  for (const Wall& wall : result.graph->walls) EXPECT_NEAR(wall.thickness_m, 0.2, 0.01);
}

TEST(SvgFrontend, LeavesOutHatching) {
  std::string hatch;
  for (int i = 0; i < 24; ++i) hatch += "M" + std::to_string(400 + 150 * i) + ",200v3000";
  const std::string text = TwoRooms("width='8500mm' viewBox='0 0 8500 3400'", "<path stroke='blue' d='" + hatch + "'/><g>");
  const CompileResult result = CompileText(text);
  ASSERT_TRUE(result.graph) << Text(result);
  EXPECT_TRUE(Says(result, DiagnosticKind::kHatchingLeftOut));
  EXPECT_EQ(result.graph->rooms.size(), 2u) << Text(result);
  EXPECT_EQ(result.graph->doorways.size(), 1u) << Text(result);
}

TEST(SvgFrontend, RefusesADrawingWithoutLines) {
  const CompileResult result = CompileText("<svg xmlns='http://www.w3.org/2000/svg'><image href='plan.png' width='10' height='10'/></svg>");
  EXPECT_FALSE(result.graph);
  EXPECT_TRUE(Says(result, DiagnosticKind::kNothingDrawn));
  EXPECT_TRUE(Says(result, DiagnosticKind::kEntityNotRead));
}

TEST(SvgFrontend, StandsAsOneStoreyOfSeveralDrawings) {
  const test::TemporaryFolder folder;
  const std::string a = folder.path() + "/a.svg", b = folder.path() + "/b.svg";
  const std::string text = TwoRooms("width='8500mm' viewBox='0 0 8500 3400'", "<g>");
  ASSERT_TRUE(WriteFileAtomically(a, std::string_view(text)) && WriteFileAtomically(b, std::string_view(text)));
  const CompileResult result = CompileStoreys({{"OG", b, 3.0}, {"EG", a, 0.0}});
  ASSERT_TRUE(result.graph) << Text(result);
  EXPECT_EQ(result.graph->storeys.size(), 2u);
  EXPECT_EQ(result.graph->rooms.size(), 4u);
}

}  // namespace
}  // namespace plumb::compiler
