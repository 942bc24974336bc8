#include "compiler/geometry/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;

Ring2 Rectangle(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

TEST(Extrude, ProfilesWithHolesInAnyOrientationAndDirection) {
  for (const bool turn_outer : {false, true}) {
    for (const bool turn_inner : {false, true}) {
      for (const Vector3d& offset : {Vector3d(0, 0, 2), Vector3d(0, 0, -2), Vector3d(1, 0.5, 2)}) {
        Ring2 outer = Rectangle(0, 0, 4, 3), inner = Rectangle(1, 1, 2, 2);
        if (turn_outer) std::reverse(outer.begin(), outer.end());
        if (turn_inner) std::reverse(inner.begin(), inner.end());
        const Solid solid = Extrude({outer, inner}, offset);
        EXPECT_TRUE(IsClosed(solid));
        EXPECT_NEAR(Volume(solid), 22, 1e-9);
      }
    }
  }
}

TEST(Extrude, ConcaveProfile) {
  const Solid solid = Extrude({{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}}, {0, 0, 1});
  EXPECT_TRUE(IsClosed(solid));
  EXPECT_NEAR(Volume(solid), 5, 1e-9);
}

TEST(Extrude, DegenerateInputGivesNothing) {
  EXPECT_TRUE(Extrude({}, {0, 0, 1}).empty());
  EXPECT_TRUE(Extrude({Rectangle(0, 0, 1, 1)}, {1, 1, 0}).empty());
  EXPECT_TRUE(Extrude({{{0, 0}, {1, 0}, {2, 0}}}, {0, 0, 1}).empty());
  EXPECT_TRUE(Extrude({{{0, 0}, {1, 0}}}, {0, 0, 1}).empty());
}

TEST(Loft, TaperedBoxIsAFrustum) {
  const Solid solid = Loft({Rectangle(-2, -2, 2, 2)}, {Rectangle(-1, -1, 1, 1)}, {0, 0, 3});
  EXPECT_TRUE(IsClosed(solid));
  EXPECT_NEAR(Volume(solid), 3.0 / 3 * (16 + 4 + 8), 1e-9);
  EXPECT_TRUE(Loft({Rectangle(0, 0, 1, 1)}, {{{0, 0}, {1, 0}, {0, 1}}}, {0, 0, 1}).empty());
}

// Pappus: area times the way of its centroid, less what the flat steps cut off.
TEST(Revolve, FullAndPartTurns) {
  for (const double angle : {2 * kPi, kPi / 2, -kPi / 2}) {
    const int steps = 256;
    const Solid solid = Revolve({Rectangle(2, 0, 3, 1)}, Vector2d(0, 0), Vector2d(0, 1), angle, steps);
    EXPECT_TRUE(IsClosed(solid));
    EXPECT_NEAR(Volume(solid), 2.5 * std::abs(angle), 0.002 * 2.5 * std::abs(angle));
  }
}

TEST(Revolve, ProfileOnTheAxisIsClosed) {
  const Solid solid = Revolve({Rectangle(0, 0, 1, 2)}, Vector2d(0, 0), Vector2d(0, 1), 2 * kPi, 128);
  EXPECT_TRUE(IsClosed(solid));
  EXPECT_NEAR(Volume(solid), 2 * kPi, 0.01);
}

TEST(SweepDisk, StraightBentAndClosedPaths) {
  const double disk = 0.5 * 64 * std::sin(2 * kPi / 64) * 0.01;  // of radius 0.1 with 64 corners
  const Solid straight = SweepDisk({{0, 0, 0}, {0, 0, 1}, {0, 0, 3}}, 0.1, 64);
  EXPECT_TRUE(IsClosed(straight));
  EXPECT_NEAR(Volume(straight), 3 * disk, 1e-9);
  const Solid bent = SweepDisk({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}}, 0.1, 64);
  EXPECT_TRUE(IsClosed(bent));
  EXPECT_NEAR(Volume(bent), 4 * disk, 1e-6);
  const Solid ring = SweepDisk({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 0}}, 0.1, 16);
  EXPECT_TRUE(IsClosed(ring));
  EXPECT_GT(Volume(ring), 0);
}

TEST(ArcSegments, ChordsStayWithinTheTolerance) {
  for (const double radius : {0.2, 1.0, 5.0}) {
    const int n = ArcSegments(radius, 2 * kPi, 0.002);
    EXPECT_LE(radius * (1 - std::cos(kPi / n)), 0.002 + 1e-12);
  }
  EXPECT_EQ(ArcSegments(1e-3, 2 * kPi, 0.002), 12);
  EXPECT_EQ(ArcSegments(1e6, 2 * kPi, 0.002), 256);
  EXPECT_GE(ArcSegments(1, 1e-9, 0.002), 1);
}

}  // namespace
}  // namespace plumb::compiler
