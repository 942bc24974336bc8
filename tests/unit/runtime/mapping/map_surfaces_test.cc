#include "runtime/mapping/map_surfaces.h"

#include <gtest/gtest.h>

namespace plumb::runtime {
namespace {

// A wall from x_min_m to x_max_m, 2 m high, at y = y_m, seen from the side of smaller y.
SurfaceTrack WallAt(double x_min_m, double x_max_m, double y_m) {
  Segment segment;
  segment.plane = {-Eigen::Vector3d::UnitY(), y_m};
  for (double x_m = x_min_m + 0.05; x_m < x_max_m; x_m += 0.1) {
    for (double z_m = 0.05; z_m < 2; z_m += 0.1) {
      segment.stats.Add({x_m, y_m, z_m});
      segment.cells.push_back(Eigen::Vector3d(x_m, y_m, z_m).cast<float>());
    }
  }
  return SurfaceOf(segment, Keyframe()).track;
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

}  // namespace
}  // namespace plumb::runtime
