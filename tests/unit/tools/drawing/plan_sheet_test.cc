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

TEST(RoomLabels, StandUprightInCorridors) {
  AGraph g = test::MakeHouse();
  g.rooms[0].name = "Corridor";
  g.rooms[0].polygon = {{0, 0}, {0.7, 0}, {0.7, 8}, {0, 8}};
  g.rooms[0].center = {0.35, 4, 0};
  EXPECT_THAT(DrawRoomLabels(g, StoreyId(0), SheetOf(g, StoreyId(0))), HasSubstr("rotate(-90 "));
}

}  // namespace
}  // namespace plumb::tools
