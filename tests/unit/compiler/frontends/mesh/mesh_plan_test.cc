#include "compiler/frontends/mesh/mesh_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "tests/unit/compiler/frontends/mesh/scenes.h"

namespace plumb::compiler {
namespace {

PlanIr PlanOf(const MeshScene& scene) {
  DiagnosticSink sink;
  return MakePlan(scene, {}, sink);
}

std::vector<PlanElement> WallsOf(const PlanIr& plan) {
  std::vector<PlanElement> out;
  std::copy_if(plan.elements.begin(), plan.elements.end(), std::back_inserter(out),
               [](const PlanElement& e) { return e.kind == ElementKind::kWall; });
  return out;
}

size_t Passages(const PlanIr& plan) {
  return static_cast<size_t>(
      std::count_if(plan.openings.begin(), plan.openings.end(), [](const PlanOpening& o) { return o.filling == kNoIndex; }));
}

TEST(MeshPlan, OfAHutHasItsWallsAndItsDoor) {
  MeshScene scene;
  test::AddHut(0, 2.7, scene);
  const PlanIr plan = PlanOf(scene);
  EXPECT_EQ(plan.storeys.size(), 1u);
  for (const PlanElement& wall : WallsOf(plan)) EXPECT_NEAR(wall.thickness_m.value_or(0), 0.2, 1e-6) << wall.guid;
  ASSERT_EQ(plan.openings.size(), 1u);
  EXPECT_EQ(Passages(plan), 1u);
  EXPECT_NEAR(plan.openings[0].width_m.value_or(0), 0.9, 1e-6);
  const Eigen::AlignedBox3d door = Bounds(plan.openings[0].body);
  EXPECT_NEAR(door.min().z(), 0, 1e-6);
  EXPECT_NEAR(door.max().z(), 2.1, 1e-6);
}

TEST(MeshPlan, HasADoorDownToTheFloorInAWallThatStandsOnAThreshold) {
  MeshScene scene;
  test::AddHut(0, 2.7, scene);
  test::AddBox("between_a", {3.4, 0.2, 0.17}, {3.5, 1.5, 2.7}, scene);
  test::AddBox("between_b", {3.4, 2.4, 0.17}, {3.5, 3.8, 2.7}, scene);
  const PlanIr plan = PlanOf(scene);
  ASSERT_EQ(Passages(plan), 2u);
  for (const PlanOpening& o : plan.openings) EXPECT_NEAR(Bounds(o.body).min().z(), 0, 1e-6);
}

TEST(MeshPlan, HasNoDoorWhereAWallGoesOnAsTwoLayers) {
  MeshScene scene;
  test::AddHut(0, 2.7, scene);
  test::AddBox("between", {3.3, 0.2, 0}, {3.6, 2.8, 2.7}, scene);
  test::AddBox("layer_a", {3.3, 2.8, 0}, {3.42, 3.8, 2.7}, scene);
  test::AddBox("layer_b", {3.48, 2.8, 0}, {3.6, 3.8, 2.7}, scene);
  EXPECT_EQ(Passages(PlanOf(scene)), 1u);
}

TEST(MeshPlan, GivesEachWallAnIdOfItsOwnWhereObjectsHaveOneName) {
  MeshScene scene;
  test::AddHut(0, 2.7, scene);
  for (MeshObject& o : scene.objects) o.name = "wall";
  const PlanIr plan = PlanOf(scene);
  std::set<std::string> ids;
  for (const PlanElement& wall : WallsOf(plan)) EXPECT_TRUE(ids.insert(wall.guid).second) << wall.guid;
  EXPECT_GE(ids.size(), 4u);
}

TEST(MeshPlan, FollowsWallsThatAreCurvedInPlan) {
  MeshScene scene;
  test::AddRing(4, 0.25, 2.7, 36, scene);
  const PlanIr plan = PlanOf(scene);
  const auto walls = WallsOf(plan);
  EXPECT_GE(walls.size(), 30u);
  for (const PlanElement& wall : walls) {
    EXPECT_NEAR(wall.thickness_m.value_or(0), 0.25, 0.01);
    EXPECT_NEAR(Bounds(wall.uncut).center().head<2>().norm(), 4.125, 0.06);
  }
}

TEST(MeshPlan, TakesTheSkinsOfADoubleWallForOneWithoutARoomBetween) {
  MeshScene scene;
  test::AddHut(0, 2.7, scene);
  test::AddBox("outer_north", {0, 4.2, 0}, {6, 4.4, 2.7}, scene);
  double covered_m = 0;
  for (const PlanElement& wall : WallsOf(PlanOf(scene))) {
    const Eigen::AlignedBox3d box = Bounds(wall.uncut);
    if (box.min().y() < 4.001 && box.max().y() > 4.199 && box.sizes().x() > 3) covered_m = box.sizes().x();
  }
  EXPECT_NEAR(covered_m, 6, 0.01);
}

// Five degrees each: no facet of the opening stands from floor to ceiling.
TEST(MeshPlan, HasOneDoorOrWindowOverTheFacetsOfACurve) {
  for (const bool door : {true, false}) {
    MeshScene scene;
    const double radius_m = 3.1 * std::cos(std::numbers::pi / 72), width_m = 2 * 3.1 * std::sin(std::numbers::pi / 18);
    test::AddRingWithOpening(3, 0.2, 2.7, 72, 4, door ? 0 : 0.9, door ? 2.1 : 2.2, scene);
    const PlanIr plan = PlanOf(scene);
    EXPECT_EQ(WallsOf(plan).size(), 1u);
    ASSERT_EQ(plan.openings.size(), 1u);
    EXPECT_NEAR(plan.openings[0].width_m.value_or(0), width_m, 0.01);
    EXPECT_EQ(plan.openings[0].filling != kNoIndex, !door);
    const Eigen::Vector2d middle(radius_m * std::cos(std::numbers::pi / 18), radius_m * std::sin(std::numbers::pi / 18));
    EXPECT_LT((Bounds(plan.openings[0].body).center().head<2>() - middle).norm(), 0.06);
  }
}

TEST(MeshPlan, KeepsEveryTriangleOfTheScene) {
  MeshScene scene;
  test::AddHut(0, 2.7, scene);
  test::AddBox("floor", {0, 0, -0.2}, {6, 4, 0}, scene);
  test::AddBox("table", {2, 2, 0}, {3, 3, 0.75}, scene);
  double in_m2 = 0, out_m2 = 0;
  for (const MeshObject& o : scene.objects) in_m2 += SurfaceArea(o.solid);
  for (const PlanElement& e : PlanOf(scene).elements) out_m2 += SurfaceArea(e.body);
  EXPECT_NEAR(out_m2, in_m2, 1e-6);
}

// Facets shorter than the wall is thick are no piers.
TEST(MeshPlan, MakesOneWallOfARingHoweverFineItsFacetsAre) {
  for (const int sides : {48, 120, 240}) {
    MeshScene scene;
    test::AddRing(3, 0.2, 2.7, sides, scene);
    const std::vector<PlanElement> walls = WallsOf(PlanOf(scene));
    ASSERT_EQ(walls.size(), 1u) << sides;
    EXPECT_NEAR(walls[0].thickness_m.value_or(0), 0.2, 1e-3) << sides;
  }
}

}  // namespace
}  // namespace plumb::compiler
