#include "tools/drawing/plan_sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/house.h"
#include "tools/drawing/floor_plan.h"
#include "tools/drawing/room_labels.h"

namespace plumb::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

AGraph TwoStoreys() {
  AGraph g = test::MakeHouse();
  g.source_path = "plans/house & home.ifc";
  g.storeys.push_back({"s1", "Roof", 3, 3});
  return g;
}

TEST(PlanSheet, HasTitleScaleRoomsAndDimensions) {
  const std::string svg = FloorPlansToSvg(TwoStoreys(), {StoreyId(0)});
  EXPECT_THAT(svg, HasSubstr(">Ground floor</text>"));
  EXPECT_THAT(svg, HasSubstr("floor plan 1:50,"));
  EXPECT_THAT(svg, HasSubstr(">house &amp; home.ifc</text>"));
  EXPECT_THAT(svg, HasSubstr(">A</text>"));
  EXPECT_THAT(svg, HasSubstr(">9.60</text>"));
  EXPECT_THAT(svg, HasSubstr(">2 m</text>"));
  EXPECT_THAT(svg, Not(HasSubstr("class=\"north\"")));
  EXPECT_EQ(svg, FloorPlansToSvg(TwoStoreys(), {StoreyId(0)}));
}

TEST(PlanSheet, PrintsToScale) {
  // 9.6 m at 1:50 are 192 mm; dimension lines, on the left only, add 20 mm, margins 2 * 3 mm.
  const std::string svg = FloorPlansToSvg(TwoStoreys(), {StoreyId(0)});
  EXPECT_THAT(svg, HasSubstr("width=\"218.00mm\""));
  EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 2180.0 "));
}

TEST(PlanSheet, NeedsNoCssVariables) {
  const std::string svg = FloorPlansToSvg(TwoStoreys(), {StoreyId(0)});
  EXPECT_THAT(svg, Not(HasSubstr("var(")));
  EXPECT_THAT(svg, HasSubstr(".plan .cut{fill:#1d2329;"));
}

TEST(PlanSheet, NorthPointsWhereThePlanSays) {
  AGraph g = TwoStoreys();
  g.true_north_rad = 0;  // along +x: a quarter turn clockwise from up
  EXPECT_THAT(FloorPlansToSvg(g, {StoreyId(0)}), HasSubstr("rotate(90.00)"));
}

TEST(PlanSheet, HoldsAllStoreysThatHaveSomethingToDraw) {
  AGraph g = TwoStoreys();
  EXPECT_THAT(DrawnStoreys(g), ::testing::ElementsAre(StoreyId(0)));
  g.walls[0].storey = StoreyId(1);
  EXPECT_THAT(DrawnStoreys(g), ::testing::ElementsAre(StoreyId(0), StoreyId(1)));
  const std::string svg = FloorPlansToSvg(g, DrawnStoreys(g));
  EXPECT_THAT(svg, HasSubstr("id=\"storey-0\""));
  EXPECT_THAT(svg, HasSubstr("id=\"storey-1\""));
  EXPECT_THAT(FloorPlansToSvg(AGraph{}, {}), HasSubstr("</svg>"));
}

// Else the cut through another storey's walls would lie over the sheets beside it.
TEST(PlanSheet, ShowsEachPlanThroughAWindow) {
  const AGraph g = TwoStoreys();
  const std::string svg = FloorPlansToSvg(g, {StoreyId(0)});
  const size_t window = svg.find("<svg width=\"2180.0\" height=");
  ASSERT_NE(window, std::string::npos);
  EXPECT_LT(window, svg.find("class=\"floor\""));
  EXPECT_LT(svg.find("class=\"dim\""), svg.find("</svg>", window));
  EXPECT_GT(svg.find("class=\"title\""), svg.find("</svg>", window));
}

TEST(PlanSheet, LargePlansGetASmallerScale) {
  AGraph g = TwoStoreys();
  g.walls[0].axis_end.x() += 50;
  EXPECT_THAT(FloorPlansToSvg(g, {StoreyId(0)}), HasSubstr("floor plan 1:200,"));
}

TEST(RoomLabels, LongNamesAreBrokenInNarrowRooms) {
  AGraph g = test::MakeHouse();
  g.rooms[0].name = "Reception and waiting room";
  g.rooms[0].polygon = {{0, 0}, {2, 0}, {2, 4}, {0, 4}};
  g.rooms[0].center = {1, 2, 0};
  const std::string svg = DrawRoomLabels(g, StoreyId(0), SheetOf(g, StoreyId(0)));
  EXPECT_THAT(svg, HasSubstr(">Reception and</text>"));
  EXPECT_THAT(svg, HasSubstr(">waiting room</text>"));
}

TEST(PlanSheet, ScaleBarsHaveRoundSteps) {
  const Eigen::Vector2d zero = Eigen::Vector2d::Zero();
  for (const auto& [denominator, first, last] : {std::tuple(20.0, ">0.2<", ">1 m<"),
                                                 {50.0, ">0.5<", ">2 m<"},
                                                 {100.0, ">1<", ">5 m<"},
                                                 {200.0, ">2<", ">10 m<"},
                                                 {500.0, ">5<", ">20 m<"}}) {
    const std::string bar = DrawScaleBar(Sheet(zero, zero, 1, denominator), 0, 0);
    EXPECT_THAT(bar, HasSubstr(first));
    EXPECT_THAT(bar, HasSubstr(last));
  }
}

TEST(PlanSheet, IsCutBelowTheCeilings) {
  AGraph g = TwoStoreys();
  EXPECT_EQ(SectionHeight(g, StoreyId(0), {.section_height_m = 2.5}), 2.5);
  EXPECT_DOUBLE_EQ(SectionHeight(g, StoreyId(0), {.section_height_m = 2.6}), 2.5);
  EXPECT_EQ(SectionHeight(g, StoreyId(1), {.section_height_m = 9}), 9) << "it has neither rooms nor walls";
  g.walls[0].storey = StoreyId(1);
  g.walls[0].z_max_m = 3.5;
  EXPECT_DOUBLE_EQ(SectionHeight(g, StoreyId(1), {}), 0.4) << "a parapet";
  g.walls[0].storey = StoreyId(0);
  EXPECT_THAT(FloorPlansToSvg(g, {StoreyId(0)}, {.section_height_m = 3}), HasSubstr("cut 2.50 m above"));
  for (Room& room : g.rooms) room.ceiling_z_m = 0.15;
  EXPECT_DOUBLE_EQ(SectionHeight(g, StoreyId(0), {}), 0.075);
}

// Two upright labels of two lines each, 30 cm of the building wide, in rooms that are 20 cm apart.
TEST(RoomLabels, DoNotCross) {
  AGraph g = test::MakeHouse();
  g.rooms.resize(2);
  for (size_t i = 0; i < 2; ++i) {
    const double x = 0.2 * static_cast<double>(i);
    g.rooms[i].polygon = {{x, 0}, {x + 0.2, 0}, {x + 0.2, 0.5}, {x, 0.5}};
    g.rooms[i].center = {x + 0.1, 0.25, 0};
    g.rooms[i].name = i == 0 ? "Wardrobe" : "Pantry";
    g.rooms[i].guid = "of the source";
  }
  const std::string svg = DrawRoomLabels(g, StoreyId(0), SheetOf(g, StoreyId(0)));
  const auto x_of = [&svg](const std::string& name) {
    const size_t begin = svg.rfind("rotate(-90 ", svg.find(">" + name + "<"));
    return std::stod(svg.substr(begin + 11));
  };
  // The one has lost its area: three half lines from one to the other.
  EXPECT_GE(std::abs(x_of("Wardrobe") - x_of("Pantry")), 3 * 0.5 * 1.15 * 13) << svg;
  EXPECT_THAT(svg, HasSubstr("m²"));
  EXPECT_EQ(svg.find("m²"), svg.rfind("m²"));
  g.rooms[0].guid = g.rooms[1].guid = "";
  EXPECT_EQ(DrawRoomLabels(g, StoreyId(0), SheetOf(g, StoreyId(0))), "") << "made names are left out";
}

TEST(RoomLabels, StandUprightInCorridors) {
  AGraph g = test::MakeHouse();
  g.rooms[0].name = "Corridor";
  g.rooms[0].polygon = {{0, 0}, {0.7, 0}, {0.7, 8}, {0, 8}};
  g.rooms[0].center = {0.35, 4, 0};
  EXPECT_THAT(DrawRoomLabels(g, StoreyId(0), SheetOf(g, StoreyId(0))), HasSubstr("rotate(-90 "));
}

}  // namespace
}  // namespace plumb::tools
