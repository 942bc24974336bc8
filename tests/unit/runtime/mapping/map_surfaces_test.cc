#include "runtime/mapping/map_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace plumb::runtime {
namespace {

// Of a wall, 2 m high, at y = y_m + lean * (x - x_min_m), seen from the side of smaller y, what `seen` takes of its cells, with so many
// points in each.
TrackedSurface Patch(double x_min_m, double x_max_m, double y_m, double lean, int cell_points,
                     const std::function<bool(double x_m, double z_m)>& seen) {
  Segment segment;
  const Eigen::Vector3d normal = Eigen::Vector3d(lean, -1, 0).normalized();
  segment.plane = {normal, -normal.dot(Eigen::Vector3d(x_min_m, y_m, 0))};
  for (double x_m = x_min_m + 0.05; x_m < x_max_m; x_m += 0.1) {
    for (double z_m = 0.05; z_m < 2; z_m += 0.1) {
      if (!seen(x_m, z_m)) continue;
      const Eigen::Vector3d p(x_m, y_m + lean * (x_m - x_min_m), z_m);
      for (int i = 0; i < cell_points; ++i) segment.stats.Add(p);
      segment.cells.push_back(p.cast<float>());
    }
  }
  return SurfaceOf(segment, Keyframe());
}

bool Everywhere(double, double) { return true; }

SurfaceTrack WallAt(double x_min_m, double x_max_m, double y_m) { return Patch(x_min_m, x_max_m, y_m, 0, 1, Everywhere).track; }

bool IsEchoOf(const TrackedSurface& b, const std::vector<TrackedSurface>& others) {
  std::vector<MapSurface> surfaces = {b.surface};
  std::vector<SurfaceTrack> tracks = {b.track};
  std::vector<Ball> balls = {b.track.patch.ball()};
  for (const TrackedSurface& other : others) {
    surfaces.push_back(other.surface);
    tracks.push_back(other.track);
    balls.push_back(other.track.patch.ball());
  }
  return IsEcho(b.surface, b.track.patch, surfaces, tracks, balls);
}

// A rectangle somewhere near the origin, of any kind, direction and size.
SurfacePatch AnyPatch(std::mt19937& rng) {
  const auto within = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(rng() >> 8) / static_cast<double>(1u << 24);
  };
  const bool wall = rng() % 3 != 0;
  const double heading_rad = 0.1 * static_cast<double>(rng() % 3) + within(-0.03, 0.03);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.rotate(Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()));
  const Eigen::Vector3d normal = wall ? Eigen::Vector3d(T.linear() * Eigen::Vector3d::UnitY()) : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d u = T.linear() * Eigen::Vector3d::UnitX(), v = normal.cross(u);
  const Eigen::Vector3d at(within(-4, 4), within(-0.1, 0.1), within(-0.1, 0.1));
  SurfacePatch patch(0, T, {normal, -normal.dot(at)}, wall ? SurfaceKind::kWall : SurfaceKind::kFloor, at, 0.1);
  const double length_m = within(0.2, 4), height_m = within(0.2, 2);
  for (const double a : {0.0, 1.0}) {
    for (const double b : {0.0, 1.0}) patch.Mark(at + a * length_m * u + b * height_m * v);
  }
  return patch;
}

TEST(MayTouch, IsTrueOfAllThatHaveADistance) {
  std::mt19937 rng(1);
  int near = 0, far = 0;
  for (int i = 0; i < 40000; ++i) {
    const SurfacePatch a = AnyPatch(rng), b = AnyPatch(rng);
    const bool may_touch = MayTouch(a.ball(), b.ball(), {});
    if (std::isfinite(SurfaceDistance(a, b, {}))) {
      ++near;
      EXPECT_TRUE(may_touch);
    }
    far += !may_touch;
  }
  EXPECT_GT(near, 500);
  EXPECT_GT(far, 1000);
}

// The same seen from so many keyframes.
TrackedSurface Seen(size_t views, const TrackedSurface& once) {
  const std::vector<Keyframe> keyframes(views);
  TrackedSurface out = once;
  for (size_t i = 1; i < views; ++i) {
    TrackedSurface again = once;
    again.surface.observations[0].keyframe = static_cast<uint32_t>(i);
    Absorb(again, keyframes, &out.surface, &out.track);
  }
  return out;
}

// Which of b's cells are left beside another surface.
std::vector<bool> EchoCellsBeside(const TrackedSurface& b, const TrackedSurface& other) {
  return EchoCells(b.surface, b.track.patch, {b.surface, other.surface}, {b.track, other.track},
                   {b.track.patch.ball(), other.track.patch.ball()});
}

TEST(FitOnePlane, TakesPartsOfOneWallInSpiteOfDrift) {
  EXPECT_TRUE(FitOnePlane(WallAt(0, 2, 1), WallAt(2.2, 4, 1), {}));
  EXPECT_TRUE(FitOnePlane(WallAt(0, 2, 1), WallAt(2.2, 4, 1.02), {}));
}

// A plane that leans across a step is near both sides of it.
TEST(FitOnePlane, RefusesAStep) {
  EXPECT_FALSE(FitOnePlane(WallAt(0, 2, 1), WallAt(2.2, 4, 1.15), {}));
  EXPECT_FALSE(FitOnePlane(WallAt(2.2, 4, 1.15), WallAt(0, 2, 1), {}));
}

TEST(SurfaceDistance, BoundsTheAngleByTheShortersLengthIfBothDirectionsAreKnown) {
  const SurfaceTrack wall = WallAt(0, 3, 1);
  const auto distance_m = [&](double lean, bool directed) {
    return SurfaceDistance(wall.patch, Patch(1, 2, 1 - 0.5 * lean, lean, 1, Everywhere).track.patch, {}, directed);
  };
  EXPECT_TRUE(std::isfinite(distance_m(0.02, true)));
  EXPECT_TRUE(std::isinf(distance_m(0.05, true)));
  EXPECT_TRUE(std::isfinite(distance_m(0.05, false)));
  EXPECT_TRUE(std::isinf(distance_m(0.11, false))) << "a wall that was built askew";
}

TEST(IsEcho, IsAFewReturnsInFrontOfAWallSeenEverywhere) {
  const TrackedSurface wall = Patch(0, 5, 1, 0, 100, Everywhere);
  EXPECT_TRUE(IsEchoOf(Patch(1, 2.4, 0.98, 0, 5, Everywhere), {wall}));
  EXPECT_TRUE(IsEchoOf(Patch(1, 2.4, 1, -0.09, 5, Everywhere), {wall})) << "leaning from the wall to a door's casing";
  EXPECT_TRUE(IsEchoOf(Patch(1, 2.4, 1, 0.09, 5, Everywhere), {wall})) << "leaning behind it";
  EXPECT_FALSE(IsEchoOf(wall, {wall}));
}

// A window's frame and the wall about it each cover a part only of a plane laid through both.
TEST(IsEcho, CountsAllStrongerSurfacesTogether) {
  const TrackedSurface left = Patch(0, 1.7, 1, 0, 100, Everywhere), right = Patch(1.9, 4, 1.06, 0, 100, Everywhere);
  const TrackedSurface between = Patch(0.8, 2.8, 1.03, 0, 5, Everywhere);
  EXPECT_FALSE(IsEchoOf(between, {left}));
  EXPECT_FALSE(IsEchoOf(between, {right}));
  EXPECT_TRUE(IsEchoOf(between, {left, right}));
}

TEST(IsEcho, IsNothingThatTheWallLeavesRoomFor) {
  const auto in_doorway = [](double x_m, double) { return x_m > 2 && x_m < 3; };
  const TrackedSurface wall = Patch(0, 5, 1, 0, 100, [&](double x_m, double z_m) { return !in_doorway(x_m, z_m); });
  EXPECT_FALSE(IsEchoOf(Patch(2, 3, 1.05, 0, 5, Everywhere), {wall})) << "a leaf in its doorway";
  EXPECT_FALSE(IsEchoOf(Patch(0.5, 1.5, 0.7, 0, 5, Everywhere), {wall})) << "a cupboard's front, seen past";
  EXPECT_FALSE(IsEchoOf(Patch(0, 5, 0.95, 0, 50, Everywhere), {wall})) << "a panelling seen half as often";
}

// Two walls that meet at a few degrees: single views of the longer one took cells of the other's.
TEST(IsEcho, IsNoWallThatTheNextOnesPlaneGrazes) {
  TrackedSurface wall = Seen(20, Patch(0, 7, 1, 0, 100, Everywhere));
  Absorb(Patch(7, 9, 1, 0, 1, Everywhere), {Keyframe()}, &wall.surface, &wall.track);
  const TrackedSurface next = Patch(7, 9, 0.93, 0.07, 5, Everywhere);
  EXPECT_FALSE(IsEchoOf(Seen(3, next), {wall}));
  EXPECT_TRUE(IsEchoOf(Seen(2, next), {wall})) << "seen hardly more often than the wall there";
}

// A door leaf that a few noisy views made as wide as its wall.
TEST(EchoCells, AreALeafsOutsideItsDoorway) {
  const auto in_doorway = [](double x_m, double) { return x_m > 2 && x_m < 3; };
  const TrackedSurface wall = Seen(6, Patch(0, 5, 1, 0, 100, [&](double x_m, double z_m) { return !in_doorway(x_m, z_m); }));
  TrackedSurface leaf = Seen(5, Patch(0, 5, 1.06, 0, 100, in_doorway));
  Absorb(Patch(0, 5, 1.06, 0, 5, Everywhere), {Keyframe()}, &leaf.surface, &leaf.track);
  ASSERT_FALSE(IsEchoOf(leaf, {wall}));
  ASSERT_NEAR(leaf.surface.length_m(), 5, 0.11);
  const std::vector<bool> echo = EchoCellsBeside(leaf, wall);
  EXPECT_EQ(std::count(echo.begin(), echo.end(), false), 200);
  const std::vector<bool> of_wall = EchoCellsBeside(wall, leaf);
  EXPECT_EQ(std::count(of_wall.begin(), of_wall.end(), true), 0);

  ASSERT_TRUE(TakeCells(echo, {}, &leaf.surface, &leaf.track));
  EXPECT_NEAR(leaf.surface.length_m(), 1, 0.11);
  EXPECT_EQ(leaf.surface.cells.size(), 200u);
  EXPECT_NEAR(leaf.surface.area_m2, 2, 1e-9);
}

TEST(TakeCells, LeavesNoScraps) {
  TrackedSurface wall = Patch(0, 2, 1, 0, 1, Everywhere);
  std::vector<bool> gone(wall.surface.cells.size(), true);
  std::fill_n(gone.begin(), 10, false);
  EXPECT_FALSE(TakeCells(gone, {}, &wall.surface, &wall.track));
}

}  // namespace
}  // namespace plumb::runtime
