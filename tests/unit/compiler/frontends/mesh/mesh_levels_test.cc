#include "compiler/frontends/mesh/mesh_levels.h"

#include <gtest/gtest.h>

#include "tests/unit/compiler/frontends/mesh/scenes.h"

namespace plumb::compiler {
namespace {

std::vector<StoreyRange> StoreysOf(const MeshScene& scene) { return FindStoreys(scene.objects, scene.objects); }

TEST(MeshLevels, OfOneOpenShellIsOne) {
  MeshScene scene;
  test::AddHut(0.4, 2.7, scene);
  const auto storeys = StoreysOf(scene);
  ASSERT_EQ(storeys.size(), 1u);
  EXPECT_NEAR(storeys[0].floor_z_m, 0.4, 1e-6);
  EXPECT_NEAR(storeys[0].top_z_m, 3.1, 0.03);
}

TEST(MeshLevels, AreToldFromSlabs) {
  MeshScene scene;
  test::AddHut(0, 2.7, scene);
  test::AddHut(2.7, 2.7, scene, "_up");
  test::AddBox("slab", {0.2, 0.2, 2.5}, {5.8, 3.8, 2.7}, scene);
  const auto storeys = StoreysOf(scene);
  ASSERT_EQ(storeys.size(), 2u);
  EXPECT_NEAR(storeys[1].floor_z_m, 2.7, 1e-6);
}

TEST(MeshLevels, AreToldFromWallsThatBeginAnewAboveASlabThatIsNotDrawn) {
  MeshScene scene;
  for (const double floor_m : {0.0, 3.0, 6.0}) test::AddHut(floor_m, 2.7, scene);
  const auto storeys = StoreysOf(scene);
  ASSERT_EQ(storeys.size(), 3u);
  EXPECT_NEAR(storeys[1].floor_z_m, 3, 1e-6);
  EXPECT_NEAR(storeys[2].floor_z_m, 6, 1e-6);
  EXPECT_NEAR(storeys[0].top_z_m, 3, 1e-6);
}

TEST(MeshLevels, AreToldFromWallsThatStandOnOthersWithDoorsOfTheirOwn) {
  MeshScene scene;
  test::AddHut(0, 2.7, scene);
  test::AddHut(2.7, 2.7, scene, "_up");
  const auto storeys = StoreysOf(scene);
  ASSERT_EQ(storeys.size(), 2u);
  EXPECT_NEAR(storeys[1].floor_z_m, 2.7, 1e-6);
}

TEST(MeshLevels, OfAHallOfPanelsAreOne) {
  MeshScene scene;
  for (const double z : {0.0, 3.0}) {
    test::AddBox("south", {0, 0, z}, {20, 0.2, z + 3}, scene);
    test::AddBox("north", {0, 9.8, z}, {20, 10, z + 3}, scene);
    test::AddBox("west", {0, 0.2, z}, {0.2, 9.8, z + 3}, scene);
    test::AddBox("east", {19.8, 0.2, z}, {20, 9.8, z + 3}, scene);
  }
  EXPECT_EQ(StoreysOf(scene).size(), 1u);
}

TEST(MeshLevels, OfAHallOnPillarsUnderABeamAreOne) {
  MeshScene scene;
  for (const double x : {0.0, 5.0, 10.0, 15.0, 19.6}) {
    for (const double y : {0.0, 9.6}) test::AddBox("pillar", {x, y, 0}, {x + 0.4, y + 0.4, 3}, scene);
  }
  test::AddBox("beam_a", {0, 0, 3}, {20, 0.4, 5.5}, scene);
  test::AddBox("beam_b", {0, 9.6, 3}, {20, 10, 5.5}, scene);
  EXPECT_EQ(StoreysOf(scene).size(), 1u);
}

TEST(MeshLevels, WithoutAnythingUprightAreNone) {
  MeshScene scene;
  MeshObject o;
  o.solid.vertices = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}};
  o.solid.triangles = {{0, 1, 2}};
  scene.objects.push_back(o);
  EXPECT_TRUE(StoreysOf(scene).empty());
}

TEST(MeshLevels, BreakAtSillsAndLintels) {
  MeshScene scene;
  test::AddHut(0, 2.7, scene);
  const auto breaks = FindBreaks(scene.objects, {0, 2.7});
  ASSERT_EQ(breaks.size(), 3u);
  EXPECT_NEAR(breaks[1], 2.1, 1e-6);
}

}  // namespace
}  // namespace plumb::compiler
