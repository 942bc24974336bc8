#include "compiler/passes/section.h"

#include <gtest/gtest.h>

#include "compiler/passes/polygon.h"
#include "tests/support/plan_builder.h"

namespace plumb::compiler {
namespace {

using test::Prism;
using test::Rectangle;

Solid Together(const Solid& a, const Solid& b) {
  Solid out = a;
  const int base = static_cast<int>(a.vertices.size());
  out.vertices.insert(out.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) out.triangles.emplace_back(t.array() + base);
  return out;
}

TEST(CutSolid, BoxGivesItsRectangleWithoutTheSeamsOfTriangles) {
  const Section s = CutSolid(Prism(Rectangle({1, 2}, {4, 2.3}), 0, 2.5), 1.1);
  ASSERT_TRUE(s.closed);
  ASSERT_EQ(s.rings.size(), 1u);
  EXPECT_EQ(s.rings[0].size(), 4u);
  EXPECT_NEAR(SignedArea(s.rings[0]), 0.9, 1e-12);
}

TEST(CutSolid, TopCountsAndBottomDoesNot) {
  const Solid box = Prism(Rectangle({0, 0}, {1, 1}), 0, 2);
  EXPECT_EQ(CutSolid(box, 2.0).rings.size(), 1u);
  EXPECT_TRUE(CutSolid(box, 0.0).rings.empty());
  EXPECT_TRUE(CutSolid(box, 2.1).rings.empty());
}

TEST(CutSolid, HollowPrismHasAHoleAndTouchingPartsMerge) {
  Solid inner = Prism(Rectangle({1, 1}, {2, 2}), 0, 2);
  for (auto& t : inner.triangles) std::swap(t[0], t[1]);  // a shaft: seen from within
  const Section hollow = CutSolid(Together(Prism(Rectangle({0, 0}, {3, 3}), 0, 2), inner), 1);
  ASSERT_EQ(hollow.rings.size(), 2u);
  EXPECT_NEAR(SignedArea(hollow.rings[0]) + SignedArea(hollow.rings[1]), 8, 1e-12);

  const Section touching = CutSolid(Together(Prism(Rectangle({0, 0}, {1, 1}), 0, 2), Prism(Rectangle({1, 0}, {2, 1}), 0, 2)), 1);
  ASSERT_EQ(touching.rings.size(), 1u);
  EXPECT_NEAR(SignedArea(touching.rings[0]), 2, 1e-12);
}

TEST(CutSolid, WrongOrientationIsPutRight) {
  Solid inside_out = Prism(Rectangle({0, 0}, {2, 1}), 0, 2);
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(SignedArea(CutSolid(inside_out, 1).rings.at(0)), 2, 1e-12);
  Solid mixed = Prism(Rectangle({0, 0}, {2, 1}), 0, 2);
  std::swap(mixed.triangles[0][0], mixed.triangles[0][1]);
  const Section s = CutSolid(mixed, 1);
  EXPECT_TRUE(s.closed);
  ASSERT_EQ(s.rings.size(), 1u);
  EXPECT_NEAR(SignedArea(s.rings[0]), 2, 1e-12);
}

TEST(CutSolid, OpenSurfaceFallsBackToTheRectangleAroundIt) {
  Solid open = Prism(Rectangle({0, 0}, {2, 1}), 0, 2);
  open.triangles.erase(open.triangles.begin(), open.triangles.begin() + 2);  // one side is missing
  const Section s = CutSolid(open, 1);
  EXPECT_FALSE(s.closed);
  ASSERT_EQ(s.rings.size(), 1u);
  EXPECT_NEAR(std::abs(SignedArea(s.rings[0])), 2, 1e-9);
}

}  // namespace
}  // namespace plumb::compiler
