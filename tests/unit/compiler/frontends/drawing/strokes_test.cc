#include "compiler/frontends/drawing/strokes.h"

#include <gtest/gtest.h>

#include "compiler/frontends/drawing/arc_band.h"
#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {
namespace {

void AddStroke(const std::vector<Eigen::Vector2d>& points, double stroke_m, Drawing& drawing, LineRole role = LineRole::kAny) {
  DrawnPath path;
  path.role = role;
  path.points = points;
  path.stroke_m = stroke_m;
  drawing.paths.push_back(path);
}

std::vector<Eigen::AlignedBox2d> WallsOf(const Drawing& drawing) {
  std::vector<Eigen::AlignedBox2d> out;
  for (const DrawnPath& path : drawing.paths) {
    if (path.role != LineRole::kWall) continue;
    EXPECT_TRUE(path.closed && path.filled);
    out.push_back(BoxOf(path.points));
  }
  return out;
}

void ExpectBox(const Eigen::AlignedBox2d& box, double x0, double y0, double x1, double y1) {
  EXPECT_NEAR(box.min().x(), x0, 1e-9);
  EXPECT_NEAR(box.min().y(), y0, 1e-9);
  EXPECT_NEAR(box.max().x(), x1, 1e-9);
  EXPECT_NEAR(box.max().y(), y1, 1e-9);
}

TEST(WidenStrokes, AThickStrokeAmongThinOnesBecomesTheOutlineOfAWall) {
  Drawing drawing;
  AddStroke({{0, 0}, {5, 0}}, 0.2, drawing);
  AddStroke({{1, 1}, {2, 1}}, 0.02, drawing);
  WidenStrokes(drawing);
  const auto walls = WallsOf(drawing);
  ASSERT_EQ(walls.size(), 1u);
  ExpectBox(walls[0], 0, -0.1, 5, 0.1);
  ASSERT_EQ(drawing.paths.size(), 2u);
  EXPECT_EQ(drawing.paths[1].role, LineRole::kOpening) << "thin lines are no walls where thick ones are";
}

TEST(WidenStrokes, EndsThatMeetAnotherStrokeReachIntoTheCorner) {
  Drawing drawing;
  AddStroke({{0, 0}, {5, 0}}, 0.2, drawing);
  AddStroke({{5, 0}, {5, 3}}, 0.2, drawing);
  AddStroke({{1, 1}, {2, 1}}, 0.02, drawing);
  WidenStrokes(drawing);
  const auto walls = WallsOf(drawing);
  ASSERT_EQ(walls.size(), 2u);
  ExpectBox(walls[0], 0, -0.1, 5.1, 0.1);
  ExpectBox(walls[1], 4.9, -0.1, 5.1, 3);
}

TEST(WidenStrokes, CornersOfOneStrokeClose) {
  Drawing drawing;
  AddStroke({{0, 0}, {5, 0}, {5, 3}}, 0.2, drawing, LineRole::kWall);
  WidenStrokes(drawing);
  const auto walls = WallsOf(drawing);
  ASSERT_EQ(walls.size(), 2u);
  ExpectBox(walls[0], 0, -0.1, 5.1, 0.1);
  ExpectBox(walls[1], 4.9, -0.1, 5.1, 3);
}

TEST(WidenStrokes, AClosedOutlineHasAWallAlongEachSide) {
  Drawing drawing;
  AddStroke({{0, 0}, {4, 0}, {4, 3}, {0, 3}}, 0.3, drawing, LineRole::kWall);
  drawing.paths[0].closed = true;
  WidenStrokes(drawing);
  const auto walls = WallsOf(drawing);
  ASSERT_EQ(walls.size(), 4u);
  ExpectBox(walls[0], -0.15, -0.15, 4.15, 0.15);
  ExpectBox(walls[3], -0.15, -0.15, 0.15, 3.15);
}

TEST(WidenStrokes, StrokesThatAreNoWallsStay) {
  Drawing drawing;
  AddStroke({{0, 0}, {5, 0}}, 0.04, drawing);  // thicker than the others, but no wall is as thin
  AddStroke({{0, 1}, {5, 1}}, 0.02, drawing);
  AddStroke({{0, 2}, {5, 2}}, 0.8, drawing);  // no wall is as thick
  WidenStrokes(drawing);
  EXPECT_TRUE(WallsOf(drawing).empty());
  ASSERT_EQ(drawing.paths.size(), 3u);
  for (const DrawnPath& path : drawing.paths) EXPECT_EQ(path.role, LineRole::kAny);
}

TEST(WidenStrokes, WhereAllStrokesAreAlikeThicknessTellsNothing) {
  Drawing drawing;
  AddStroke({{0, 0}, {5, 0}}, 0.2, drawing);
  AddStroke({{0, 2}, {5, 2}}, 0.2, drawing);
  WidenStrokes(drawing);
  EXPECT_TRUE(WallsOf(drawing).empty());
}

TEST(WidenStrokes, LayersOfWallsTellBeforeThickness) {
  Drawing drawing;
  AddStroke({{0, 0}, {5, 0}}, 0.1, drawing, LineRole::kWall);
  AddStroke({{0, 2}, {5, 2}}, 0.4, drawing);  // furniture
  AddStroke({{0, 4}, {5, 4}}, 0.02, drawing);
  WidenStrokes(drawing);
  const auto walls = WallsOf(drawing);
  ASSERT_EQ(walls.size(), 1u);
  ExpectBox(walls[0], 0, -0.05, 5, 0.05);
  EXPECT_EQ(drawing.paths[1].role, LineRole::kAny);
}

TEST(BandsAlong, StayWithinAMillimetreOfTheArcHoweverLargeItIs) {
  for (const double radius_m : {0.5, 4.0, 100.0, 300.0}) {
    const Arc arc{{0, 0}, radius_m, 0.2, 0.3};
    const std::vector<ArcBand> bands = BandsAlong(arc, 0.1, 0, 0);
    ASSERT_EQ(bands.size(), 1u);
    const std::vector<Eigen::Vector2d>& outline = bands[0].outline;
    for (size_t i = 0; i + 1 < outline.size() / 2; ++i) {
      EXPECT_NEAR((0.5 * (outline[i] + outline[i + 1])).norm(), radius_m - 0.1, 0.0011) << radius_m;
    }
  }
}

}  // namespace
}  // namespace plumb::compiler
