#include "compiler/passes/planar_map.h"

#include <gtest/gtest.h>

#include "compiler/passes/face_locator.h"
#include "compiler/passes/floor_outlines.h"
#include "compiler/passes/polygon.h"
#include "compiler/passes/snap.h"
#include "tests/support/plan_builder.h"
#include "tests/unit/compiler/passes/build.h"

namespace plumb::compiler {
namespace {

using test::Rectangle;

std::vector<double> FreeAreas(const Floor& floor) {
  std::vector<double> out;
  for (const FloorFace& f : floor.faces) {
    if (f.bounded() && f.cover.empty()) out.push_back(f.area_m2);
  }
  std::sort(out.begin(), out.end());
  return out;
}

TEST(PlanarMap, CrossingWallsShareTheFaceWhereTheyCross) {
  Floor floor = FloorOf({Rectangle({0, 1}, {3, 2}), Rectangle({1, 0}, {2, 3})});
  ASSERT_TRUE(BuildPlanarMap(floor, {}));
  ASSERT_EQ(floor.faces.size(), 6u);  // outside, four arms, the middle
  const uint32_t middle = FaceLocator(floor).FaceAt({1.5, 1.5});
  EXPECT_EQ(floor.faces[middle].cover, (std::vector<uint32_t>{0, 1}));
  EXPECT_NEAR(floor.faces[middle].area_m2, 1, 1e-12);
  EXPECT_EQ(FaceLocator(floor).FaceAt({5, 5}), 0u);
}

// Four walls around [0,4] x [0,3]; the ends of two of them stop `gap_m` short of the others.
Floor Box(double gap_m) {
  return FloorOf({Rectangle({-0.2, -0.2}, {4.2, 0}), Rectangle({-0.2, 3}, {4.2, 3.2}), Rectangle({-0.2, gap_m}, {0, 3 - gap_m}),
                  Rectangle({4, gap_m}, {4.2, 3 - gap_m})});
}

TEST(PlanarMap, GapsWithinTheSnapRadiusClose) {
  for (double gap : {0.0, 0.0004, 0.001, 0.0019}) {
    Floor floor = Box(gap);
    ASSERT_TRUE(BuildPlanarMap(floor, {}));
    const std::vector<double> free = FreeAreas(floor);
    ASSERT_EQ(free.size(), 1u) << gap;
    EXPECT_NEAR(free[0], 12, 0.01) << gap;
    for (const FloorFace& f : floor.faces) EXPECT_TRUE(!f.bounded() || f.area_m2 > 0.1) << "a sliver of " << f.area_m2;
  }
}

TEST(PlanarMap, WiderGapsStayOpen) {
  Floor floor = Box(0.02);
  ASSERT_TRUE(BuildPlanarMap(floor, {}));
  EXPECT_TRUE(FreeAreas(floor).empty());
  PlanarMapOptions wide;
  wide.snap_radius_m = 0.03;
  ASSERT_TRUE(BuildPlanarMap(floor, wide));
  EXPECT_EQ(FreeAreas(floor).size(), 1u);
}

TEST(PlanarMap, AFreeStandingWallIsAHole) {
  Floor floor = Box(0);
  floor.footprints.push_back({FootprintKind::kWall, 4, 4, true, {Rectangle({1, 1}, {2, 1.2})}});
  ASSERT_TRUE(BuildPlanarMap(floor, {}));
  const FloorFace& room = floor.faces[FaceLocator(floor).FaceAt({3, 2})];
  ASSERT_EQ(room.holes.size(), 1u);
  EXPECT_NEAR(room.area_m2, 12 - 0.2, 1e-9);
  EXPECT_LT(SignedArea(FaceRings(floor, room)[1]), 0);
}

TEST(PlanarMap, TheOrderOfFootprintsDoesNotMatter) {
  Floor forward = Box(0.001), backward = Box(0.001);
  std::reverse(backward.footprints.begin(), backward.footprints.end());
  ASSERT_TRUE(BuildPlanarMap(forward, {}));
  ASSERT_TRUE(BuildPlanarMap(backward, {}));
  EXPECT_EQ(forward.vertices, backward.vertices);
  ASSERT_EQ(forward.faces.size(), backward.faces.size());
  for (size_t i = 0; i < forward.faces.size(); ++i) EXPECT_EQ(FaceRings(forward, forward.faces[i]), FaceRings(backward, backward.faces[i]));
}

TEST(PlanarMap, FootprintsThatDoNotBoundRoomsAreLeftOut) {
  Floor floor = Box(0);
  floor.footprints[0].bounds_rooms = false;
  ASSERT_TRUE(BuildPlanarMap(floor, {}));
  EXPECT_TRUE(FreeAreas(floor).empty());
}

TEST(PlanarMap, WhatSnappingLeavesCrossedIsResolvedExactly) {
  const std::vector<Ring> triangles = Tangle();
  Floor floor = FloorOf(triangles);
  PlanarMapOptions options;
  options.snap_radius_m = kTangleRadius_m;
  ASSERT_FALSE(Snap(OutlinesOf(floor), options.snap_radius_m).is_planar);
  ASSERT_TRUE(BuildPlanarMap(floor, options));
  EXPECT_FALSE(floor.faces[0].bounded());
  for (uint32_t t = 0; t < triangles.size(); ++t) {
    double covered_m2 = 0;
    for (const FloorFace& f : floor.faces) covered_m2 += std::binary_search(f.cover.begin(), f.cover.end(), t) ? f.area_m2 : 0;
    EXPECT_NEAR(covered_m2, SignedArea(triangles[t]), 1e-9) << t;
  }
}

TEST(PlanarMap, AnEmptyLevelHasTheOutsideOnly) {
  Floor floor;
  ASSERT_TRUE(BuildPlanarMap(floor, {}));
  ASSERT_EQ(floor.faces.size(), 1u);
  EXPECT_FALSE(floor.faces[0].bounded());
}

}  // namespace
}  // namespace plumb::compiler
