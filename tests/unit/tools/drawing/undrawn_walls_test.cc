#include "tools/drawing/undrawn_walls.h"

#include <gtest/gtest.h>

#include "tests/support/house.h"

namespace plumb::tools {
namespace {

// A wall along x from 0 to 4, 0.2 m thick, of which the mesh has the box from 0 to `to_m`, its first upright face missing if `is_open`.
AGraph OneWall(double to_m, bool is_open) {
  AGraph g;
  g.storeys.emplace_back();
  Wall wall;
  wall.storey = StoreyId(0);
  wall.axis_start = {0, 0};
  wall.axis_end = {4, 0};
  wall.thickness_m = 0.2;
  wall.z_max_m = 3;
  g.walls.push_back(wall);
  Element e;
  e.kind = ElementKind::kWall;
  e.wall = WallId(0);
  g.elements.push_back(e);
  test::AddBox(g, {0, -0.1, 0}, {to_m, 0.1, 3}, 0);
  if (is_open) g.mesh.triangles.erase(g.mesh.triangles.begin() + 4, g.mesh.triangles.begin() + 6);
  return g;
}

std::vector<Ring> Undrawn(const AGraph& g) {
  const auto segments = SegmentsAt(g, 1.1);
  return UndrawnWalls(g, StoreyId(0), 1.1, segments, ClosedSections(segments));
}

TEST(UndrawnWalls, FillsAWallWhoseOutlineDoesNotClose) {
  const std::vector<Ring> pieces = Undrawn(OneWall(4, true));
  ASSERT_EQ(pieces.size(), 1u);
  Eigen::AlignedBox2d box;
  for (const auto& p : pieces[0]) box.extend(p);
  EXPECT_TRUE(box.isApprox(Eigen::AlignedBox2d(Eigen::Vector2d(0, -0.1), Eigen::Vector2d(4, 0.1)), 1e-9));
}

TEST(UndrawnWalls, LeavesOpeningsAndWhatAnotherElementShows) {
  AGraph g = OneWall(4, true);
  Window window;
  window.storey = StoreyId(0);
  window.wall = WallId(0);
  window.position = {1, 0, 0.9};
  window.width_m = 1;
  window.height_m = 1.2;
  g.windows.push_back(window);
  g.elements.emplace_back();
  test::AddBox(g, {3, -0.2, 0}, {4.5, 0.2, 3}, 1);  // a pier over the wall's end
  const std::vector<Ring> pieces = Undrawn(g);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_NEAR(pieces[0][1].x(), 0.5, 0.06);
  EXPECT_NEAR(pieces[1][0].x(), 1.5, 0.06);
  EXPECT_NEAR(pieces[1][1].x(), 3, 0.06);
}

TEST(UndrawnWalls, AWallThatClosesEndsWhereItEnds) {
  EXPECT_TRUE(Undrawn(OneWall(2.5, false)).empty()) << "under a roof, say";
}

}  // namespace
}  // namespace plumb::tools
