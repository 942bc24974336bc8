#include "compiler/frontends/mesh/mesh_frame.h"

#include <gtest/gtest.h>

#include "tests/unit/compiler/frontends/mesh/scenes.h"

namespace plumb::compiler {
namespace {

MeshScene ScaledHut(double scale) {
  MeshScene scene;
  test::AddHut(0, 2.7, scene);
  test::Turn(Eigen::Affine3d(Eigen::Scaling(scale)), scene);
  return scene;
}

double HeightOf(const MeshScene& scene) {
  Eigen::AlignedBox3d box;
  for (const MeshObject& o : scene.objects) box.extend(Bounds(o.solid));
  return box.sizes().z();
}

TEST(MeshFrame, IsMetresWhateverTheUnit) {
  for (const double unit_m : {1.0, 0.001, 0.01, 0.0254, 0.3048}) {
    MeshScene scene = ScaledHut(1 / unit_m);
    DiagnosticSink sink;
    MoveToPlanFrame({}, scene, sink);
    EXPECT_NEAR(HeightOf(scene), 2.7, 1e-6) << unit_m;
  }
}

TEST(MeshFrame, TakesTheUnitThatTheCallerStates) {
  MeshScene scene = ScaledHut(1000);
  DiagnosticSink sink;
  MeshOptions options;
  options.unit = "cm";
  MoveToPlanFrame(options, scene, sink);
  EXPECT_NEAR(HeightOf(scene), 27, 1e-6);
}

TEST(MeshFrame, SaysThatTheFormatsUnitContradictsTheWalls) {
  MeshScene scene = ScaledHut(1000);
  scene.unit_m = 1;
  DiagnosticSink sink;
  MoveToPlanFrame({}, scene, sink);
  EXPECT_NEAR(HeightOf(scene), 2.7, 1e-6);
  EXPECT_EQ(sink.Count(Severity::kWarning), 1u);
}

TEST(MeshFrame, TurnsYUpToZUp) {
  MeshScene scene = ScaledHut(1);
  test::Turn(Eigen::Affine3d(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitX())), scene);
  scene.up = UpAxis::kY;
  DiagnosticSink sink;
  MoveToPlanFrame({}, scene, sink);
  const Eigen::AlignedBox3d south = Bounds(scene.objects[0].solid);
  EXPECT_TRUE(south.min().isApprox(Eigen::Vector3d(0, 0, 0)) || south.min().norm() < 1e-9);
  EXPECT_TRUE(south.max().isApprox(Eigen::Vector3d(2, 0.2, 2.7)));
}

TEST(MeshFrame, TurnsAndScalesTheOriginWithTheCorners) {
  MeshScene scene = ScaledHut(1000);
  scene.origin = {2000000, 3000000, 0};
  DiagnosticSink sink;
  MoveToPlanFrame({}, scene, sink);
  EXPECT_TRUE(scene.origin.isApprox(Eigen::Vector3d(2000, 3000, 0)));
}

// More heights than places: several storeys of one room, and nothing stated.
TEST(MeshFrame, OfSeveralStoreysIsFoundWhicheverAxisIsUp) {
  for (const double unit_m : {1.0, 0.001}) {
    for (const bool y_up : {false, true}) {
      MeshScene scene;
      for (int storey = 0; storey < 2; ++storey) {
        test::AddHut(2.9 * storey, 2.7, scene, std::to_string(storey));
        test::AddBox("slab" + std::to_string(storey), {0, 0, 2.9 * storey + 2.7}, {6, 4, 2.9 * storey + 2.9}, scene);
      }
      if (y_up) test::Turn(Eigen::Affine3d(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitX())), scene);
      test::Turn(Eigen::Affine3d(Eigen::Scaling(1 / unit_m)), scene);
      DiagnosticSink sink;
      MoveToPlanFrame({}, scene, sink);
      EXPECT_NEAR(HeightOf(scene), 5.8, 1e-6) << unit_m << (y_up ? " y" : " z");
    }
  }
}

}  // namespace
}  // namespace plumb::compiler
