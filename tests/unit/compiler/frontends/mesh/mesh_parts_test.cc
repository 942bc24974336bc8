#include "compiler/frontends/mesh/mesh_parts.h"

#include <gtest/gtest.h>

#include "tests/unit/compiler/frontends/mesh/scenes.h"

namespace plumb::compiler {
namespace {

const std::vector<FaceDirection> kAlongX = {FaceDirection()};

WallPiece Piece(double s0_m, double s1_m, double c0_m, double c1_m, uint32_t group) {
  WallPiece out;
  out.span = {s0_m, s1_m};
  out.c0_m = c0_m;
  out.c1_m = c1_m;
  out.z1_m = 2.5;
  out.group = group;
  return out;
}

size_t Count(const StoreyWalls& storey, size_t piece, uint32_t object) {
  const auto found = storey.triangles[piece].find(object);
  return found == storey.triangles[piece].end() ? 0 : found->second.size();
}

TEST(MeshParts, TrianglesGoToTheWallWhoseBoxHoldsThem) {
  MeshScene scene;
  test::AddBox("wall", {0, 0, 0}, {5, 0.2, 2.5}, scene);
  test::AddBox("table", {1, 2, 0}, {2, 3, 0.8}, scene);
  std::vector<StoreyWalls> storeys = {{{0, 2.5}, {Piece(0, 5, 0, 0.2, 1)}, {}}};
  const auto taken = AssignTriangles(scene.objects, kAlongX, storeys);
  EXPECT_EQ(Count(storeys[0], 0, 0), 12u);
  EXPECT_EQ(Count(storeys[0], 0, 1), 0u);
  EXPECT_EQ(taken[0], std::vector<bool>(12, true));
  EXPECT_EQ(taken[1], std::vector<bool>(12, false));
}

TEST(MeshParts, OfTwoWallsInOnePlaceATriangleTakesThatOfItsOwnObject) {
  MeshScene scene;
  test::AddBox("a", {0, 0, 0}, {5, 0.2, 2.5}, scene);
  test::AddBox("b", {0, 0, 0}, {5, 0.2, 2.5}, scene);
  std::vector<StoreyWalls> storeys = {{{0, 2.5}, {Piece(0, 5, 0, 0.2, 1), Piece(0, 5, 0, 0.2, 2)}, {}}};
  (void)AssignTriangles(scene.objects, kAlongX, storeys);
  EXPECT_EQ(Count(storeys[0], 0, 0), 12u);
  EXPECT_EQ(Count(storeys[0], 1, 1), 12u);
  EXPECT_EQ(Count(storeys[0], 0, 1) + Count(storeys[0], 1, 0), 0u);
}

TEST(MeshParts, AFloorThatLiesOverAWallWithItsMiddleOnlyIsNoPartOfIt) {
  MeshScene scene;
  test::AddBox("slab", {-3, -3, -0.2}, {8, 3, 0}, scene);
  std::vector<StoreyWalls> storeys = {{{0, 2.5}, {Piece(-2, 7, -1.2, 1.2, kPool)}, {}}};
  (void)AssignTriangles(scene.objects, kAlongX, storeys);
  EXPECT_EQ(Count(storeys[0], 0, 0), 0u);
}

TEST(MeshParts, TrianglesGoToTheLowestStoreyThatHoldsThem) {
  MeshScene scene;
  test::AddBox("wall", {0, 0, 0}, {5, 0.2, 2.5}, scene);
  std::vector<StoreyWalls> storeys(2, {{0, 2.5}, {Piece(0, 5, 0, 0.2, kPool)}, {}});
  (void)AssignTriangles(scene.objects, kAlongX, storeys);
  EXPECT_EQ(Count(storeys[0], 0, 0), 12u);
  EXPECT_EQ(Count(storeys[1], 0, 0), 0u);
}

TEST(MeshParts, APooledWallBelongsToTheObjectOfMostOfItsFaces) {
  MeshScene scene;
  test::AddBox("skirting", {0, 0, 0}, {5, 0.2, 0.1}, scene);
  test::AddBox("wall", {0, 0, 0.1}, {5, 0.2, 2.5}, scene);
  std::vector<StoreyWalls> storeys = {{{0, 2.5}, {Piece(0, 5, 0, 0.2, kPool)}, {}}};
  (void)AssignTriangles(scene.objects, kAlongX, storeys);
  EXPECT_EQ(OwnerOf(scene.objects, storeys[0], 0), 1u);
  storeys[0].pieces[0].group = 1;
  EXPECT_EQ(OwnerOf(scene.objects, storeys[0], 0), 0u) << "a wall of one object belongs to that";
}

TEST(MeshParts, APartHasTheCornersOfItsTrianglesAlone) {
  MeshScene scene;
  test::AddBox("wall", {0, 0, 0}, {5, 0.2, 2.5}, scene);
  const Solid& box = scene.objects[0].solid;
  Solid part;
  AppendPart(box, {0}, part);
  ASSERT_EQ(part.triangles.size(), 1u);
  ASSERT_EQ(part.vertices.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    const auto corner = static_cast<size_t>(box.triangles[0][k]), of_part = static_cast<size_t>(part.triangles[0][k]);
    EXPECT_EQ(part.vertices[of_part], box.vertices[corner]);
  }
  AppendPart(box, {0, 1}, part);
  EXPECT_EQ(part.triangles.size(), 3u);
}

}  // namespace
}  // namespace plumb::compiler
