#include "compiler/geometry/triangulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace plumb::compiler {
namespace {

double AreaOf(const Triangulation2& t) {
  double sum = 0;
  for (const Eigen::Vector3i& tri : t.triangles) {
    const auto p = [&](int k) { return t.points[static_cast<size_t>(tri[k])]; };
    const double area = SignedArea(std::vector<Eigen::Vector2d>{p(0), p(1), p(2)});
    EXPECT_GE(area, 0);
    sum += area;
  }
  return sum;
}

Ring2 Square(double x, double y, double size) { return {{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}}; }

TEST(TriangulatePolygon, SmallPolygonsEitherWayRound) {
  Ring2 quad = Square(0, 0, 2);
  EXPECT_DOUBLE_EQ(AreaOf(TriangulatePolygon(std::vector<Ring2>{quad})), 4);
  std::reverse(quad.begin(), quad.end());
  EXPECT_DOUBLE_EQ(AreaOf(TriangulatePolygon(std::vector<Ring2>{quad})), 4);
  EXPECT_DOUBLE_EQ(AreaOf(TriangulatePolygon(std::vector<Ring2>{{{0, 0}, {0, 1}, {1, 0}}})), 0.5);
}

TEST(TriangulatePolygon, ConvexPolygonsAreCutFromOneCorner) {
  Ring2 circle;
  for (int i = 0; i < 12; ++i) circle.emplace_back(std::cos(i * std::numbers::pi / 6), std::sin(i * std::numbers::pi / 6));
  for (int turn = 0; turn < 2; ++turn) {
    const Triangulation2 result = TriangulatePolygon(std::vector<Ring2>{circle});
    EXPECT_EQ(result.triangles.size(), 10u);
    EXPECT_NEAR(AreaOf(result), 3, 1e-12);
    std::reverse(circle.begin(), circle.end());
  }
}

// It turns left at each corner as a convex polygon does, but goes round twice.
TEST(TriangulatePolygon, APentagramIsNotConvex) {
  Ring2 star;
  for (int i = 0; i < 5; ++i) star.emplace_back(std::cos(i * 0.8 * std::numbers::pi), std::sin(i * 0.8 * std::numbers::pi));
  const Triangulation2 result = TriangulatePolygon(std::vector<Ring2>{star});
  EXPECT_EQ(result.points.size(), 10u);                                        // its sides cross in five more
  EXPECT_LT(AreaOf(result), std::abs(SignedArea(star)) - 0.1);  // which counts the middle twice
}

TEST(TriangulatePolygon, ConcaveQuadStaysInside) {
  const Ring2 arrow = {{0, 0}, {4, -2}, {1, 0}, {4, 2}};
  EXPECT_NEAR(AreaOf(TriangulatePolygon(std::vector<Ring2>{arrow})), std::abs(SignedArea(arrow)), 1e-12);
}

TEST(TriangulatePolygon, HolesAreLeftOutWhateverTheirOrientation) {
  const std::vector<Ring2> rings = {Square(0, 0, 10), Square(1, 1, 2), Square(5, 5, 3)};
  EXPECT_NEAR(AreaOf(TriangulatePolygon(rings)), 100 - 4 - 9, 1e-9);
}

TEST(TriangulatePolygon, IslandsInHolesCount) {
  const std::vector<Ring2> rings = {Square(0, 0, 10), Square(1, 1, 8), Square(3, 3, 2)};
  EXPECT_NEAR(AreaOf(TriangulatePolygon(rings)), 100 - 64 + 4, 1e-9);
}

TEST(TriangulatePolygon, CollinearCornersAreAllUsed) {
  const Ring2 ring = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}};
  const Triangulation2 result = TriangulatePolygon(std::vector<Ring2>{ring});
  EXPECT_NEAR(AreaOf(result), 2, 1e-12);
  std::vector<char> used(6, 0);
  for (const auto& t : result.triangles) {
    for (int k = 0; k < 3; ++k) used[static_cast<size_t>(t[k])] = 1;
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), 1), 6);
}

TEST(TriangulatePolygon, CrossingSidesGetAPoint) {
  const Ring2 bow_tie = {{0, 0}, {2, 2}, {2, 0}, {0, 2}};
  const Triangulation2 result = TriangulatePolygon(std::vector<Ring2>{bow_tie});
  EXPECT_EQ(result.points.size(), 5u);
  EXPECT_NEAR(AreaOf(result), 2, 1e-9);
}

TEST(TriangulatePolygon, DegenerateInputGivesNothing) {
  EXPECT_TRUE(TriangulatePolygon({}).triangles.empty());
  EXPECT_TRUE(TriangulatePolygon(std::vector<Ring2>{{{0, 0}, {1, 1}, {2, 2}}}).triangles.empty());
  EXPECT_TRUE(TriangulatePolygon(std::vector<Ring2>{{{0, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 0}}}).triangles.empty());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(TriangulatePolygon(std::vector<Ring2>{{{0, 0}, {1, nan}, {2, 0}, {3, 3}, {1, 5}}}).triangles.empty());
}

TEST(AppendFace, KeepsTheOrientationOfTheRing) {
  const Ring3 ring = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0.5, 1.5, 1}, {0, 1, 1}};
  Solid up, down;
  ASSERT_TRUE(AppendFace(std::vector<Ring3>{ring}, up));
  ASSERT_TRUE(AppendFace(std::vector<Ring3>{Ring3(ring.rbegin(), ring.rend())}, down));
  const auto normal_z = [](const Solid& s) {
    const auto& t = s.triangles[0];
    const auto p = [&](int k) { return s.vertices[static_cast<size_t>(t[k])]; };
    return (p(1) - p(0)).cross(p(2) - p(0)).z();
  };
  EXPECT_GT(normal_z(up), 0);
  EXPECT_LT(normal_z(down), 0);
  EXPECT_NEAR(SurfaceArea(up), 1.25, 1e-12);
}

TEST(DropRepeatedPoints, AlsoAcrossTheEnd) {
  Ring2 ring = {{0, 0}, {0, 1e-9}, {1, 0}, {1, 1}, {0, 0}};
  DropRepeatedPoints(1e-6, ring);
  EXPECT_EQ(ring.size(), 3u);
}

}  // namespace
}  // namespace plumb::compiler
