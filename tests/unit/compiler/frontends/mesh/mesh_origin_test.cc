#include "compiler/frontends/mesh/mesh_origin.h"

#include <gtest/gtest.h>

#include "tests/unit/compiler/frontends/mesh/scenes.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector3d;

TEST(MeshOrigin, OfAnObjFarFromZeroIsTakenFromItsText) {
  Vector3d origin = Vector3d::Zero();
  const auto text = ObjNearZero("o w\nv 1000000.25 4000000.5 3 0.5\nvn 0 0 1\nv 1000001.25 4000000.5 3\nf 1 2 3\n", origin);
  ASSERT_TRUE(text);
  EXPECT_EQ(origin, Vector3d(1000000, 4000001, 3));
  EXPECT_EQ(*text, "o w\nv 0.25 -0.5 0 0.5\nvn 0 0 1\nv 1.25 -0.5 0\nf 1 2 3\n");
}

TEST(MeshOrigin, OfAnObjNearZeroStays) {
  Vector3d origin = Vector3d::Zero();
  EXPECT_FALSE(ObjNearZero("v 12 40 3\nv 1e6 0 0\n", origin));
  EXPECT_TRUE(origin.isZero());
}

TEST(MeshOrigin, LeavesLinesThatAreNoCornersAsTheyAre) {
  Vector3d origin = Vector3d::Zero();
  const auto text = ObjNearZero("v 1e6 0 0\nv nan 0 0\nv 1e6\nv", origin);
  ASSERT_TRUE(text);
  EXPECT_EQ(*text, "v 0 0 0\nv nan 0 0\nv 1e6\nv\n");
}

TEST(MeshOrigin, OfASceneFarFromZeroIsItsMiddleInWholeUnits) {
  MeshScene scene;
  test::AddBox("wall", {1000, 2000, 0}, {1006, 2000.2, 2.5}, scene);
  MoveSceneNearZero(scene);
  EXPECT_EQ(scene.origin, Vector3d(1003, 2000, 1));
  EXPECT_TRUE(Bounds(scene.objects[0].solid).min().isApprox(Vector3d(-3, 0, -1)));
}

TEST(MeshOrigin, OfASceneNearZeroStays) {
  MeshScene scene;
  test::AddBox("wall", {20, 10, 0}, {26, 10.2, 2.5}, scene);
  MoveSceneNearZero(scene);
  EXPECT_TRUE(scene.origin.isZero());
}

TEST(MeshOrigin, BlursByTheStepOfSinglePrecision) {
  MeshScene scene;
  test::AddBox("wall", {0, 5000000, 0}, {6, 5000001, 2.5}, scene);
  EXPECT_DOUBLE_EQ(BlurOf(scene), 0.5);
}

}  // namespace
}  // namespace plumb::compiler
