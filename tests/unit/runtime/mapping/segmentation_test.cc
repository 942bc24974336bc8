#include "runtime/mapping/segmentation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace plumb::runtime {
namespace {

// How deep the house is at (y, z), seen from the origin along x.
using Depth = std::function<double(double y_m, double z_m)>;

// Three sweeps of rings, `step_m` apart in height on the house, with noise along x. Heights are the sensor's.
KeyframeWindow Sweeps(const Depth& depth, double y_max_m, double z_min_m, double z_max_m, double step_m, double noise_m) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, noise_m);
  KeyframeWindow window(MapperOptions(), 0, Eigen::Isometry3d::Identity());
  for (int k = 0; k < 3; ++k) {
    Scan scan;
    scan.stamp_s = 0.1 * k;
    for (double z_m = z_min_m + 0.002 * k; z_m <= z_max_m; z_m += step_m) {
      for (double y_m = -y_max_m; y_m < y_max_m; y_m += 0.02) {
        scan.points.push_back(Eigen::Vector3d(depth(y_m, z_m) + noise(random), y_m, z_m).cast<float>());
      }
    }
    window.Add(scan, Eigen::Isometry3d::Identity(), false);
  }
  return window;
}

// With a leaf 6 cm behind the wall, the wall's own returns with most noise are nearer to the leaf's plane, all over the wall.
TEST(ExtractSegments, KeepsADoorLeafInItsDoorway) {
  const auto in_doorway = [](double y_m, double z_m) { return y_m > 0 && y_m < 1 && z_m < 0.6; };
  const KeyframeWindow window = Sweeps([&](double y_m, double z_m) { return in_doorway(y_m, z_m) ? 3.06 : 3.0; }, 2, -0.8, 1.2, 0.05, 0.02);
  double leaf_cells = 0;
  for (const Segment& segment : ExtractSegments(window, {})) {
    const double at_m = segment.plane.SignedDistance({3.0, 0, 0});
    if (std::abs(at_m) < 0.02) continue;  // the wall
    EXPECT_NEAR(at_m, 0.06, 0.006);
    leaf_cells += static_cast<double>(segment.cells.size());
    for (const Eigen::Vector3f& cell : segment.cells) {
      EXPECT_TRUE(cell.y() > -0.15F && cell.y() < 1.15F && cell.z() < 0.75F) << cell.transpose();
    }
  }
  EXPECT_GT(leaf_cells, 100) << "of 140";
}

// The rings of a lidar with 2 degrees between them pass half a metre apart there: once or not at all through each of the first surfels.
TEST(ExtractSegments, FindsAWallThatIsFarAway) {
  const std::vector<Segment> segments = ExtractSegments(Sweeps([](double, double) { return 14.0; }, 1.5, -0.7, 1.5, 0.49, 0.02), {});
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_EQ(segments[0].kind, SurfaceKind::kWall);
  EXPECT_NEAR(segments[0].plane.SignedDistance({0, 0, 0}), 14.0, 0.01);
  EXPECT_LT(segments[0].plane.n.x(), -0.9995);
}

// A pane that few rays come back from, and a lintel 12 cm before it that one or two rings reach: planes through rings of both lean.
TEST(ExtractSegments, LeansNoWallFromAPaneToItsLintel) {
  int with_a_wall = 0;
  for (int i = 0; i < 20; ++i) {
    const double lowest_m = 0.3 + 0.01 * i;
    const KeyframeWindow window = Sweeps([](double, double z_m) { return z_m > 1.5 ? 5.0 : 5.12; }, 1, lowest_m, 1.9, 0.2, 0.03);
    const std::vector<Segment> segments = ExtractSegments(window, {});
    with_a_wall += !segments.empty();
    for (const Segment& segment : segments) {
      EXPECT_LT(std::abs(segment.plane.n.z()), std::sin(0.2618)) << "rings from " << lowest_m << " m";
    }
  }
  EXPECT_GT(with_a_wall, 10);
}

}  // namespace
}  // namespace plumb::runtime
