#include "runtime/mapping/cell_planes.h"

#include <gtest/gtest.h>

#include <random>

namespace plumb::runtime {
namespace {

// Two pieces of wall, 2 m high: 6 m of it at y = 0 and, after 1 m of something else, 1 m at y = step_m, seen from smaller y: cells of a few
// noisy points.
std::vector<PlaneStats> TwoPieces(double step_m, int cell_points, double noise_m) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, noise_m);
  std::vector<PlaneStats> cells;
  for (double x_m = 0.05; x_m < 8; x_m += kCell_m) {
    if (x_m > 6 && x_m < 7) continue;
    for (double z_m = 0.05; z_m < 2; z_m += kCell_m) {
      PlaneStats& cell = cells.emplace_back();
      for (int i = 0; i < cell_points; ++i) cell.Add({x_m, (x_m > 7 ? step_m : 0) + noise(random), z_m});
    }
  }
  return cells;
}

std::vector<Segment> Split(const std::vector<PlaneStats>& cells, double noise_m) {
  const Eigen::Vector3d normal = -Eigen::Vector3d::UnitY();
  const PlaneAxes axes = AxesOf({normal, 0}, SurfaceKind::kWall, Eigen::Vector3d::UnitZ());
  return SplitCells(cells, SurfaceKind::kWall, normal, axes, noise_m, {});
}

// Each cell is known to 13 mm only: most of those on the small piece are within the noise of the large one's plane.
TEST(SplitCells, TellsAStepThatFewCellsTellAlone) {
  const std::vector<Segment> segments = Split(TwoPieces(0.03, 5, 0.03), 0.03);
  ASSERT_EQ(segments.size(), 2u);
  for (const Segment& segment : segments) {
    const double x_m = segment.stats.centroid().x();
    EXPECT_NEAR(x_m, x_m < 6.5 ? 3 : 7.5, 0.15);
    EXPECT_NEAR(segment.plane.SignedDistance({x_m, 0, 1}), x_m < 6.5 ? 0 : 0.03, 0.004);
    EXPECT_GT(segment.cells.size(), x_m < 6.5 ? 1100u : 160u) << "of 1200 and 200";
  }
}

TEST(SplitCells, LeavesAFlatWallWhole) {
  const std::vector<Segment> segments = Split(TwoPieces(0, 5, 0.03), 0.03);
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_GT(segments[0].cells.size(), 1330u) << "of 1400";
}

}  // namespace
}  // namespace plumb::runtime
