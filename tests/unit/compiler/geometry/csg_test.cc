#include "compiler/geometry/csg.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "compiler/geometry/sweep.h"

namespace plumb::compiler {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;

Solid Difference(const Solid& a, const Solid& b) {
  const Expected<Solid> result = Subtract(a, b);
  EXPECT_TRUE(result.has_value());
  return result.value_or(Solid());
}

// Closed, as seen by the flux of a constant field as well as edge by edge.
void ExpectClosed(const Solid& solid) {
  EXPECT_TRUE(IsClosed(solid));
  Vector3d flux = Vector3d::Zero();
  for (const auto& t : solid.triangles) {
    const auto p = [&](int k) { return solid.vertices[static_cast<size_t>(t[k])]; };
    flux += (p(1) - p(0)).cross(p(2) - p(0)) / 2;
  }
  EXPECT_LT(flux.norm(), 1e-5);
}

TEST(Subtract, WindowThroughAWall) {
  const Solid wall = MakeBox({0, 0, 0}, {5, 0.3, 2.5}), window = MakeBox({1, -0.1, 0.9}, {2.2, 0.4, 2.1});
  const Solid result = Difference(wall, window);
  EXPECT_NEAR(Volume(result), 5 * 0.3 * 2.5 - 1.2 * 0.3 * 1.2, 1e-9);
  ExpectClosed(result);
}

TEST(SubtractAll, AsOneAfterTheOther) {
  const Solid wall = MakeBox({0, 0, 0}, {40, 0.3, 2.5});
  std::vector<Solid> tools;
  for (int i = 0; i < 20; ++i) tools.push_back(MakeBox({1 + 1.9 * i, -0.1, 0.3 * (i % 4)}, {2 + 1.9 * i, i % 3 == 0 ? 0.2 : 0.4, 2.1}));
  tools.push_back(MakeBox({5, 1, 0}, {6, 2, 1}));  // beside the wall
  std::vector<const Solid*> all;
  Solid expected = wall;
  for (const Solid& tool : tools) {
    all.push_back(&tool);
    expected = Difference(expected, tool);
  }
  const Expected<DifferenceOfMany> result = SubtractAll(wall, all);
  ASSERT_TRUE(result);
  EXPECT_NEAR(Volume(result->rest), Volume(expected), 1e-9);
  EXPECT_NEAR(SurfaceArea(result->rest), SurfaceArea(expected), 1e-6);
  ExpectClosed(result->rest);
  for (size_t t = 0; t < all.size(); ++t) EXPECT_EQ(result->cuts[t], t < 20) << t;
}

TEST(SubtractAll, SaysThatAToolTookAllOfAPiece) {
  Solid two = MakeBox({0, 0, 0}, {1, 1, 1});
  AppendSolid(MakeBox({3, 0, 0}, {4, 1, 1}), two);
  const Solid around = MakeBox({2.5, -1, -1}, {4.5, 2, 2}), away = MakeBox({1.2, 0, 0}, {2, 1, 1});
  const std::array<const Solid*, 2> tools = {&away, &around};
  const Expected<DifferenceOfMany> result = SubtractAll(two, tools);
  ASSERT_TRUE(result);
  EXPECT_NEAR(Volume(result->rest), 1, 1e-9);
  EXPECT_EQ(result->cuts, (std::vector<bool>{false, true}));
}

TEST(Subtract, OpeningFlushWithBothFacesLeavesNoSkin) {
  const Solid wall = MakeBox({0, 0, 0}, {5, 0.3, 2.5});
  for (const double noise_m : {0.0, 4e-7, -4e-7}) {
    const Solid result = Difference(wall, MakeBox({1, noise_m, 0}, {2, 0.3 - noise_m, 2}));
    EXPECT_NEAR(Volume(result), 5 * 0.3 * 2.5 - 0.6, 1e-5);
    ExpectClosed(result);
    // No triangle lies across the opening.
    for (const auto& t : result.triangles) {
      const Vector3d center = (result.vertices[static_cast<size_t>(t[0])] + result.vertices[static_cast<size_t>(t[1])] +
                               result.vertices[static_cast<size_t>(t[2])]) /
                              3;
      EXPECT_FALSE(center.x() > 1.001 && center.x() < 1.999 && center.z() < 1.999) << center.transpose();
    }
  }
}

TEST(Subtract, TouchingFromOutsideChangesNothing) {
  const Solid a = MakeBox({0, 0, 0}, {1, 1, 1});
  EXPECT_NEAR(Volume(Difference(a, MakeBox({1, 0, 0}, {2, 1, 1}))), 1, 1e-12);
  EXPECT_NEAR(Volume(Difference(a, MakeBox({1, -1, -1}, {2, 3, 3}))), 1, 1e-12);
  EXPECT_NEAR(Volume(Difference(a, MakeBox({5, 5, 5}, {6, 6, 6}))), 1, 1e-12);
}

TEST(Subtract, EverythingAndTheSameLeaveNothing) {
  const Solid a = MakeBox({0, 0, 0}, {1, 1, 1});
  EXPECT_TRUE(Difference(a, a).empty());
  EXPECT_TRUE(Difference(a, MakeBox({-1, -1, -1}, {2, 2, 2})).empty());
}

TEST(Subtract, CavityInsideIsClosed) {
  const Solid result = Difference(MakeBox({0, 0, 0}, {3, 3, 3}), MakeBox({1, 1, 1}, {2, 2, 2}));
  EXPECT_NEAR(Volume(result), 26, 1e-9);
  ExpectClosed(result);
}

TEST(Subtract, TShapedWallAndOpeningAcrossTheJoint) {
  const Ring2 t_shape = {{0, 0}, {6, 0}, {6, 0.3}, {3.15, 0.3}, {3.15, 3}, {2.85, 3}, {2.85, 0.3}, {0, 0.3}};
  const Solid wall = Extrude({t_shape}, {0, 0, 2.5});
  const double area = 6 * 0.3 + 0.3 * 2.7;
  EXPECT_NEAR(Volume(wall), area * 2.5, 1e-9);
  const Solid result = Difference(wall, MakeBox({2.5, -1, 1}, {3.5, 0.5, 2}));  // takes 1 x 0.3 and 0.3 x 0.2
  EXPECT_NEAR(Volume(result), area * 2.5 - 1 * 0.3 - 0.3 * 0.2, 1e-9);
  ExpectClosed(result);
}

TEST(Subtract, ConcaveTool) {
  const Ring2 l_shape = {{1, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 3}, {1, 3}};
  const Solid tool = Extrude({l_shape}, {0, 0, 4});
  const Solid result = Difference(MakeBox({0, 0, 1}, {4, 4, 2}), tool);
  EXPECT_NEAR(Volume(result), 16 - 3, 1e-9);
  ExpectClosed(result);
}

TEST(Subtract, RoundColumnThroughASlab) {
  Ring2 circle;
  for (int i = 0; i < 64; ++i) circle.emplace_back(std::cos(2 * std::numbers::pi * i / 64), std::sin(2 * std::numbers::pi * i / 64));
  const double area = SignedArea(circle);
  const Solid result = Difference(MakeBox({-2, -2, 0}, {2, 2, 0.5}), Extrude({circle}, {0, 0, 0.5}));
  EXPECT_NEAR(Volume(result), (16 - area) * 0.5, 1e-9);
  ExpectClosed(result);
}

TEST(Subtract, ManyOpeningsOneAfterTheOther) {
  Solid wall = MakeBox({0, 0, 0}, {40, 0.4, 3});
  for (int i = 0; i < 20; ++i) wall = Difference(wall, MakeBox({2.0 * i + 0.5, 0, 0.8}, {2.0 * i + 1.5, 0.4, 2.2}));
  EXPECT_NEAR(Volume(wall), 40 * 0.4 * 3 - 20 * 1 * 0.4 * 1.4, 1e-8);
  ExpectClosed(wall);
  EXPECT_LT(wall.triangles.size(), 2500u);
}

TEST(Subtract, OverlappingOpeningsCountOnce) {
  Solid wall = MakeBox({0, 0, 0}, {4, 0.3, 3});
  wall = Difference(wall, MakeBox({1, -1, 1}, {2, 1, 2}));
  wall = Difference(wall, MakeBox({1.5, -1, 0.5}, {2.5, 1, 1.5}));
  EXPECT_NEAR(Volume(wall), 3.6 - 0.3 * (1 + 1 - 0.25), 1e-9);
  ExpectClosed(wall);
}

TEST(Subtract, RotatedFarFromZero) {
  Affine3d T = Affine3d::Identity();
  T.translate(Vector3d(123456.7, -654321.1, 42)).rotate(Eigen::AngleAxisd(0.37, Vector3d::UnitZ()));
  Solid wall = MakeBox({0, 0, 0}, {5, 0.3, 2.5}), door = MakeBox({1, 0, 0}, {2, 0.3, 2.1});
  TransformSolid(T, wall);
  TransformSolid(T, door);
  const Solid result = Difference(wall, door);
  EXPECT_NEAR(Volume(result), 3.75 - 0.63, 1e-6);
  ExpectClosed(result);
}

// vol(a - b) + vol(a - (a - b)) = vol(a) for boxes in any position.
TEST(Subtract, PartsAddUpForRandomBoxes) {
  std::mt19937_64 rng(7);
  const auto uniform = [&rng] { return static_cast<double>(rng() >> 11) * 0x1p-53; };
  for (int i = 0; i < 60; ++i) {
    const Solid a = MakeBox({0, 0, 0}, {1 + uniform(), 1 + uniform(), 1 + uniform()});
    Affine3d T = Affine3d::Identity();
    T.translate(Vector3d(uniform(), uniform(), uniform()))
        .rotate(Eigen::AngleAxisd(uniform() * 6, Vector3d(uniform(), uniform(), 1).normalized()));
    const Solid b = MakeBox({-0.6, -0.5, -0.4}, {0.5, 0.6, 0.7}, T);
    const Solid outside = Difference(a, b), inside = Difference(a, outside);
    ExpectClosed(outside);
    EXPECT_NEAR(Volume(outside) + Volume(inside), Volume(a), 1e-6) << i;
    EXPECT_LE(Volume(inside), Volume(b) + 1e-6);
    EXPECT_GE(Volume(inside), -1e-9);
  }
}

TEST(Subtract, UncutTrianglesArePassedOn) {
  const Solid wall = MakeBox({0, 0, 0}, {5, 0.3, 2.5});
  const Solid same = Difference(wall, MakeBox({1, 1, 1}, {2, 2, 2}));
  EXPECT_EQ(same.triangles.size(), wall.triangles.size());
}

TEST(CutByPlane, KeepsTheSideBehindThePlane) {
  const Solid box = MakeBox({0, 0, 0}, {2, 2, 2});
  const Vector3d n = Vector3d(1, 0, 1).normalized();
  const Expected<Solid> half = CutByPlane(box, n, -n.dot(Vector3d(1, 1, 1)));
  ASSERT_TRUE(half.has_value());
  EXPECT_NEAR(Volume(*half), 4, 1e-9);
  ExpectClosed(*half);
  for (const Vector3d& v : half->vertices) EXPECT_LT(n.dot(v - Vector3d(1, 1, 1)), 1e-5);
  const Expected<Solid> all = CutByPlane(box, Vector3d::UnitZ(), -100), none = CutByPlane(box, Vector3d::UnitZ(), 100);
  ASSERT_TRUE(all && none);
  EXPECT_NEAR(Volume(*all), 8, 1e-9);
  EXPECT_TRUE(none->empty());
}

TEST(ClipOutside, CutsAnOpenSurface) {
  Solid sheet;
  sheet.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Expected<Solid> result = ClipOutside(sheet, MakeBox({1, -1, 1}, {2, 1, 2}));
  ASSERT_TRUE(result.has_value());
  EXPECT_NEAR(SurfaceArea(*result), 11, 1e-9);
}

TEST(CsgOptions, LimitsAreErrorsNotLongWaits) {
  const Expected<Solid> result = Subtract(MakeBox({0, 0, 0}, {1, 1, 1}), MakeBox({0.2, 0.2, -1}, {0.8, 0.8, 2}), {.max_polygons = 2});
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::kInternal);
  EXPECT_EQ(CsgOptions().Check(), "");
  EXPECT_NE(CsgOptions{.plane_epsilon_m = 0}.Check().find("plane_epsilon_m"), std::string::npos);
}

}  // namespace
}  // namespace plumb::compiler
