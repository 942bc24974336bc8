#include "tools/drawing/floor_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/house.h"
#include "tools/drawing/plan_sheet.h"

namespace plumb::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string Svg(const AGraph& graph) { return FloorPlansToSvg(graph, {StoreyId(0)}); }

size_t Count(const std::string& text, const std::string& part) {
  size_t n = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(FloorPlanSvg, DrawsWallsDoorsAndRooms) {
  const AGraph house = test::MakeHouse();
  const std::string svg = Svg(house);
  EXPECT_EQ(Count(svg, "class=\"cut\""), 7u);  // six walls and the chimney
  EXPECT_EQ(Count(svg, "class=\"swing\""), 1u);
  EXPECT_EQ(Count(svg, "class=\"lintel\""), 2u);  // two doorways without a leaf
  EXPECT_THAT(svg, HasSubstr(">A</text>"));
  EXPECT_THAT(svg, HasSubstr(">16.99 m²</text>"));
  EXPECT_EQ(svg, Svg(house));
}

TEST(FloorPlanSvg, HasRoomForCurvedWalls) {
  AGraph house = test::MakeHouse();
  const Eigen::AlignedBox2d straight = BoundsOf(house, StoreyId(0));
  Surface round = house.surfaces[0];
  round.arc = Arc{{straight.max().x(), 2}, 1.5, -std::numbers::pi / 2, std::numbers::pi};
  round.start = {straight.max().x(), 0.5};
  round.end = {straight.max().x(), 3.5};
  house.surfaces.push_back(round);
  EXPECT_NEAR(BoundsOf(house, StoreyId(0)).max().x(), straight.max().x() + 1.5, 1e-3);
  const Ring points = PointsAlong(round);
  EXPECT_TRUE(points.front().isApprox(round.start, 1e-9));
  EXPECT_TRUE(points.back().isApprox(round.end, 1e-9));
}

TEST(FloorPlanSvg, FallsBackToTheAxisWhereAWallHasNoTriangles) {
  AGraph house = test::MakeHouse();
  house.mesh = {};
  EXPECT_EQ(Count(Svg(house), "class=\"cut\""), 9u);  // six walls, three of them parted by a doorway
}

TEST(FloorPlanSvg, LeafOfAnOuterDoorOpensInwards) {
  // D3 lies in the west wall, 1.2 to 2.1 on the y axis; inside is +x. Its leaf hangs at the jamb nearer to a corner, y = 1.2.
  const AGraph house = test::MakeHouse();
  const Sheet sheet = SheetOf(house, StoreyId(0));
  EXPECT_THAT(DrawFloorPlan(house, StoreyId(0), sheet), HasSubstr("class=\"leaf\" d=\"" + sheet.Line({0, 1.2}, {0.9, 1.2}) + "\""));
}

TEST(FloorPlanSvg, WideDoorsHaveTwoLeaves) {
  AGraph house = test::MakeHouse();
  house.doorways[2].width_m = 1.6;
  EXPECT_EQ(Count(Svg(house), "class=\"leaf\""), 2u);
}

TEST(FloorPlanSvg, EscapesNamesFromTheFile) {
  AGraph house = test::MakeHouse();
  house.rooms[0].name = "<script>\"&'\x01";
  const std::string svg = Svg(house);
  EXPECT_THAT(svg, Not(HasSubstr("<script>")));
  EXPECT_THAT(svg, HasSubstr("&lt;script&gt;&quot;&amp;&#39;<"));
}

TEST(FloorPlanSvg, AnEmptyStoreyIsAnEmptySheet) {
  AGraph g;
  g.storeys.push_back({"s", "S", 0, 3});
  const std::string svg = Svg(g);
  EXPECT_EQ(Count(svg, "class=\"cut\""), 0u);
  EXPECT_EQ(Count(svg, "class=\"dim\""), 0u);
}

TEST(Sheet, MapsPlanMetresToCentimetresWithYDown) {
  const Sheet sheet({-1, -2}, {4, 3}, 0.5);
  EXPECT_EQ(sheet.width(), 600);
  EXPECT_EQ(sheet.At({-1.5, 3.5}), "0.0 0.0");
  EXPECT_EQ(sheet.At({4.5, -2.5}), "600.0 600.0");
  EXPECT_EQ(Sheet({-1, -2}, {4, 3}, 0.5, 50).width(), 1200);
}

TEST(Signed, HasATrueMinusAndNoSignForZero) {
  EXPECT_EQ(Signed(-20.34, 1), "\u221220.3");
  EXPECT_EQ(Signed(1.25, 2), "+1.25");
  EXPECT_EQ(Signed(-0.04, 1), "0.0");
}

TEST(DeviationColor, IsSymmetricAboutGreyAndClamped) {
  EXPECT_EQ(DeviationColor(0, 0.2), "#aaa5b4");
  EXPECT_EQ(DeviationColor(0.5, 0.2), DeviationColor(0.2, 0.2));
  EXPECT_NE(DeviationColor(0.2, 0.2), DeviationColor(-0.2, 0.2));
}

}  // namespace
}  // namespace plumb::tools
