#include "compiler/frontends/mesh/mesh_sections.h"

#include <gtest/gtest.h>

#include "compiler/frontends/mesh/mesh_bands.h"
#include "tests/unit/compiler/frontends/mesh/scenes.h"

namespace plumb::compiler {
namespace {

SectionStack StackAt(const MeshScene& scene, double z_m) { return {{z_m}, {CutScene(scene.objects, z_m)}}; }

TEST(MeshSections, CutABoxIntoItsOutline) {
  MeshScene scene;
  test::AddBox("wall", {0, 0, 0}, {5, 0.2, 2.5}, scene);
  double length_m = 0;
  for (const FaceSegment& f : CutScene(scene.objects, 1)) length_m += (f.b - f.a).norm();
  EXPECT_NEAR(length_m, 10.4, 1e-9);
  EXPECT_TRUE(CutScene(scene.objects, 2.6).empty());
}

TEST(MeshSections, HaveTheDirectionsOfTheWallsTheLongestFirst) {
  MeshScene scene;
  test::AddBox("wall", {0, 0, 0}, {5, 0.2, 2.5}, scene);
  test::Turn(Eigen::Affine3d(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ())), scene);
  const auto directions = FindDirections(scene.objects);
  ASSERT_EQ(directions.size(), 2u);
  EXPECT_NEAR(std::abs(directions[0].along.dot(Eigen::Vector2d(std::cos(0.3), std::sin(0.3)))), 1, 1e-9);
}

TEST(MeshSections, TellWhichWayFacesLook) {
  MeshScene scene;
  test::AddHut(0, 2.5, scene);
  EXPECT_EQ(FindFacing(FindDirections(scene.objects), StackAt(scene, 1), {}), Facing::kOutward);
  for (MeshObject& o : scene.objects) {
    for (Eigen::Vector3i& t : o.solid.triangles) std::swap(t[1], t[2]);
  }
  EXPECT_EQ(FindFacing(FindDirections(scene.objects), StackAt(scene, 1), {}), Facing::kInward);
}

TEST(MeshBands, PairTheFacesOfAWall) {
  MeshScene scene;
  test::AddBox("wall", {0, 0, 0}, {5, 0.2, 2.5}, scene);
  const auto directions = FindDirections(scene.objects);
  const auto bands = FindBands(directions, StackAt(scene, 1), {0}, Facing::kOutward, {});
  const auto wall = std::find_if(bands.begin(), bands.end(), [](const Band& b) { return !b.sheet; });
  ASSERT_NE(wall, bands.end());
  EXPECT_NEAR(wall->c1_m - wall->c0_m, 0.2, 1e-9);
  ASSERT_EQ(wall->spans[0].size(), 1u);
  EXPECT_NEAR(wall->spans[0][0].s1_m - wall->spans[0][0].s0_m, 5, 1e-9);
}

TEST(MeshBands, OfAFaceWithoutAPartnerAreSheets) {
  MeshScene scene;
  MeshObject o;
  o.solid.vertices = {{0, 0, 0}, {5, 0, 0}, {5, 0, 2.5}, {0, 0, 2.5}};
  o.solid.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.objects.push_back(o);
  const auto bands = FindBands(FindDirections(scene.objects), StackAt(scene, 1), {0}, Facing::kUnknown, {});
  ASSERT_EQ(bands.size(), 1u);
  EXPECT_TRUE(bands[0].sheet);
  EXPECT_NEAR(bands[0].c1_m - bands[0].c0_m, MeshOptions().sheet_thickness_m, 1e-9);
}

}  // namespace
}  // namespace plumb::compiler
