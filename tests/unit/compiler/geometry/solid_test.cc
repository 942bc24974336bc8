#include "compiler/geometry/solid.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plumb::compiler {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;

TEST(Solid, BoxHasItsVolumeAreaAndBounds) {
  const Solid box = MakeBox({1, 2, 3}, {3, 5, 7});
  EXPECT_TRUE(IsClosed(box));
  EXPECT_DOUBLE_EQ(Volume(box), 2 * 3 * 4);
  EXPECT_DOUBLE_EQ(SurfaceArea(box), 2 * (6 + 8 + 12));
  EXPECT_EQ(Bounds(box).min(), Vector3d(1, 2, 3));
  EXPECT_EQ(Bounds(box).max(), Vector3d(3, 5, 7));
}

TEST(Solid, MirroringKeepsNormalsOutward) {
  Solid box = MakeBox({0, 0, 0}, {1, 2, 3});
  Affine3d mirror = Affine3d::Identity();
  mirror.linear()(1, 1) = -2;
  TransformSolid(mirror, box);
  EXPECT_TRUE(IsClosed(box));
  EXPECT_NEAR(Volume(box), 12, 1e-12);
}

TEST(Solid, VolumeKeepsItsDigitsFarFromZero) {
  Solid box = MakeBox({0, 0, 0}, {1, 1, 1});
  TransformSolid(Affine3d(Eigen::Translation3d(1e6, -5e6, 0)), box);
  EXPECT_NEAR(Volume(box), 1, 1e-8);
}

TEST(IsClosed, MissingOrTurnedTriangleOpensTheSurface) {
  Solid box = MakeBox({0, 0, 0}, {1, 1, 1});
  Solid open = box;
  open.triangles.pop_back();
  EXPECT_FALSE(IsClosed(open));
  std::swap(box.triangles[0][0], box.triangles[0][1]);
  EXPECT_FALSE(IsClosed(box));
  EXPECT_FALSE(IsClosed(Solid()));
}

// Triangles with corners of their own, jittered within the tolerance: also across borders of the welder's cells.
TEST(WeldSolid, JoinsCornersWithinTheTolerance) {
  const Solid box = MakeBox({-1.6e-5, 0, 1}, {1, 1, 2});
  Solid soup;
  int n = 0;
  for (const Eigen::Vector3i& t : box.triangles) {
    for (int k = 0; k < 3; ++k) {
      soup.vertices.push_back(box.vertices[static_cast<size_t>(t[k])] + Vector3d::Constant(2e-7 * std::sin(n++)));
    }
    soup.triangles.emplace_back(n - 3, n - 2, n - 1);
  }
  EXPECT_FALSE(IsClosed(soup));
  WeldSolid(1e-6, soup);
  EXPECT_EQ(soup.vertices.size(), 8u);
  EXPECT_TRUE(IsClosed(soup));
}

TEST(WeldSolid, DropsTrianglesThatLoseACorner) {
  Solid solid;
  solid.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1e-8, 0}, {0, 1, 0}};
  solid.triangles = {{0, 1, 2}, {0, 1, 3}};
  WeldSolid(1e-6, solid);
  EXPECT_EQ(solid.triangles.size(), 1u);
  EXPECT_EQ(solid.vertices.size(), 3u);
}

TEST(OrientOutward, TurnsInsideOutAndMixedSolids) {
  Solid inside_out = MakeBox({0, 0, 0}, {1, 1, 1});
  FlipSolid(inside_out);
  OrientOutward(inside_out);
  EXPECT_NEAR(Volume(inside_out), 1, 1e-12);

  Solid mixed = MakeBox({0, 0, 0}, {1, 1, 1});
  for (size_t t = 0; t < mixed.triangles.size(); t += 3) std::swap(mixed.triangles[t][0], mixed.triangles[t][1]);
  OrientOutward(mixed);
  EXPECT_TRUE(IsClosed(mixed));
  EXPECT_NEAR(Volume(mixed), 1, 1e-12);
}

TEST(OrientOutward, KeepsACavityOfAClosedSolid) {
  Solid hollow = MakeBox({0, 0, 0}, {3, 3, 3});
  Solid cavity = MakeBox({1, 1, 1}, {2, 2, 2});
  FlipSolid(cavity);
  AppendSolid(cavity, hollow);
  OrientOutward(hollow);
  EXPECT_NEAR(Volume(hollow), 26, 1e-12);
}

TEST(ConnectedPieces, SplitsWhatSharesNoVertex) {
  Solid two = MakeBox({0, 0, 0}, {1, 1, 1});
  AppendSolid(MakeBox({2, 0, 0}, {4, 1, 1}), two);
  const std::vector<Solid> pieces = ConnectedPieces(two);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_DOUBLE_EQ(Volume(pieces[0]), 1);
  EXPECT_DOUBLE_EQ(Volume(pieces[1]), 2);
  EXPECT_EQ(pieces[0].vertices.size(), 8u);
}

}  // namespace
}  // namespace plumb::compiler
