#include "tools/drawing/section.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/house.h"

namespace plumb::tools {
namespace {

double SignedArea(const Ring& ring) {
  double twice = 0;
  for (size_t i = 0; i < ring.size(); ++i) {
    const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

uint32_t AddElement(AGraph& g, ElementKind kind) {
  Element e;
  e.kind = kind;
  g.elements.push_back(e);
  return static_cast<uint32_t>(g.elements.size() - 1);
}

TEST(CutAt, GivesOneRingOfTheRightAreaPerBox) {
  AGraph g;
  const uint32_t element = AddElement(g, ElementKind::kWall);
  test::AddBox(g, {1, 2, 0}, {4, 2.3, 3}, element);
  test::AddBox(g, {6, 2, 0}, {7, 4, 3}, element);
  const auto sections = CutAt(g, 1.1);
  ASSERT_EQ(sections.size(), 1u);
  ASSERT_EQ(sections[0].rings.size(), 2u);
  EXPECT_NEAR(std::abs(SignedArea(sections[0].rings[0])), 0.9, 1e-5);
  EXPECT_NEAR(std::abs(SignedArea(sections[0].rings[1])), 2.0, 1e-5);
  // Solid to the left: outer rings run counter-clockwise.
  EXPECT_GT(SignedArea(sections[0].rings[0]), 0);
}

TEST(CutAt, MissesWhatLiesBelowAndAbove) {
  AGraph g;
  test::AddBox(g, {0, 0, 0}, {1, 1, 1.0}, AddElement(g, ElementKind::kFurniture));
  test::AddBox(g, {0, 0, 1.2}, {1, 1, 2}, AddElement(g, ElementKind::kFurniture));
  EXPECT_TRUE(CutAt(g, 1.1).empty());
}

TEST(CutAt, IsClosedWhereTheCutGoesThroughCorners) {
  AGraph g;
  test::AddBox(g, {0, 0, 0}, {1, 1, 1.1}, AddElement(g, ElementKind::kWall));
  test::AddBox(g, {2, 0, 1.1}, {3, 1, 2}, AddElement(g, ElementKind::kWall));
  const auto sections = CutAt(g, 1.1);
  for (const auto& s : sections) {
    for (const Ring& ring : s.rings) EXPECT_NEAR(std::abs(SignedArea(ring)), 1.0, 1e-6);
  }
  EXPECT_EQ(sections.size(), 1u);  // corners at the cut count as above it
}

TEST(CutAt, LeavesOutOpenSkins) {
  AGraph g;
  test::AddBox(g, {0, 0, 0}, {1, 1, 2}, AddElement(g, ElementKind::kWall));
  g.mesh.triangles.erase(g.mesh.triangles.begin() + 4, g.mesh.triangles.begin() + 6);  // one upright face
  EXPECT_TRUE(CutAt(g, 1.1).empty());
}

TEST(EdgesSeenFromAbove, ShowsTheBorderOfATreadButNoDiagonals) {
  AGraph g;
  test::AddBox(g, {0, 0, 0}, {1, 0.3, 0.2}, AddElement(g, ElementKind::kStair));
  test::AddBox(g, {5, 5, 0}, {6, 6, 0.2}, AddElement(g, ElementKind::kWall));
  const auto edges = EdgesSeenFromAbove(g, -0.1, 1.1);
  EXPECT_EQ(edges.size(), 4u);
  for (const auto& [a, b] : edges) EXPECT_TRUE(a.x() == b.x() || a.y() == b.y());
  EXPECT_TRUE(EdgesSeenFromAbove(g, 0.5, 1.1).empty());
}

}  // namespace
}  // namespace plumb::tools
