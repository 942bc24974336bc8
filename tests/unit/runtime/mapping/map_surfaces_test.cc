#include "runtime/mapping/map_surfaces.h"

#include <gtest/gtest.h>

#include <functional>

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
  for (const TrackedSurface& other : others) {
    surfaces.push_back(other.surface);
    tracks.push_back(other.track);
  }
  return IsEcho(b.surface, b.track.patch, surfaces, tracks);
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

}  // namespace
}  // namespace plumb::runtime
