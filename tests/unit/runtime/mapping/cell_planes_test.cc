#include "runtime/mapping/cell_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>

namespace plumb::runtime {
namespace {

// A wall 8 m long and 2 m high, seen from smaller y, as deep at x as `depth` tells, NaN for nothing: cells of a few noisy points.
std::vector<CellStats> Wall(const std::function<double(double x_m)>& depth, int cell_points, double noise_m, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_m);
  std::vector<CellStats> cells;
  for (double x_m = 0.05; x_m < 8; x_m += kCell_m) {
    const double y_m = depth(x_m);
    for (double z_m = 0.05; z_m < 2 && !std::isnan(y_m); z_m += kCell_m) {
      CellStats& cell = cells.emplace_back();
      for (int i = 0; i < cell_points; ++i) cell.Add({x_m, y_m + noise(random), z_m});
    }
  }
  return cells;
}

// 6 m of wall and, after 1 m of something else, 1 m more.
double TwoPieces(double x_m, double step_m) { return x_m < 6 ? 0 : x_m > 7 ? step_m : std::nan(""); }

std::vector<Segment> Split(const std::vector<CellStats>& cells, double noise_m) {
  const Eigen::Vector3d normal = -Eigen::Vector3d::UnitY();
  const PlaneAxes axes = AxesOf({normal, 0}, SurfaceKind::kWall, Eigen::Vector3d::UnitZ());
  return SplitCells(cells, SurfaceKind::kWall, normal, axes, noise_m, {});
}

// Each cell is known to 13 mm only: most of those on the small piece are within the noise of the large one's plane.
TEST(SplitCells, TellsAStepThatFewCellsTellAlone) {
  const std::vector<Segment> segments = Split(Wall([](double x_m) { return TwoPieces(x_m, 0.03); }, 5, 0.03), 0.03);
  ASSERT_EQ(segments.size(), 2u);
  for (const Segment& segment : segments) {
    const double x_m = segment.stats.centroid().x();
    EXPECT_NEAR(x_m, x_m < 6.5 ? 3 : 7.5, 0.15);
    EXPECT_NEAR(segment.plane.SignedDistance({x_m, 0, 1}), x_m < 6.5 ? 0 : 0.03, 0.004);
    EXPECT_GT(segment.cells.size(), x_m < 6.5 ? 1100u : 160u) << "of 1200 and 200";
  }
}

TEST(SplitCells, LeavesAFlatWallWhole) {
  const std::vector<Segment> segments = Split(Wall([](double x_m) { return TwoPieces(x_m, 0); }, 5, 0.03), 0.03);
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_GT(segments[0].cells.size(), 1330u) << "of 1400";
}

// The last of them as at a corner, where the next wall's noise comes in before this wall: it stays in the extent and leans nothing.
TEST(SplitCells, CellsThatAnotherPlaneClaimsTellNothingOfThePlane) {
  std::vector<CellStats> cells = Wall([](double x_m) { return x_m > 7.7 ? -0.006 : x_m < 6.5 ? std::nan("") : 0; }, 100, 0.01);
  const Segment leaning = Split(cells, 0.01).at(0);
  for (CellStats& cell : cells) {
    if (cell.centroid().x() > 7.7) cell.contested = 0.5 * cell.count();
  }
  const Segment straight = Split(cells, 0.01).at(0);
  EXPECT_GT(std::abs(leaning.plane.n.x()), 0.002);
  EXPECT_LT(std::abs(straight.plane.n.x()), 0.0006);
  EXPECT_EQ(straight.cells.size(), leaning.cells.size());
  EXPECT_LT(straight.stats.count(), leaning.stats.count());
  for (CellStats& cell : cells) cell.contested = cell.count();
  EXPECT_EQ(Split(cells, 0.01).at(0).stats.count(), leaning.stats.count()) << "else nothing would be known of a door leaf before its wall";
}

// A pier between two windows: behind its ends stand the reveals, too narrow to be planes of their own. Their points stray into the pier's
// last cells.
TEST(SplitCells, WhatIsAtItsEndsLeansNoPier) {
  const auto pier = [](double left_m, double right_m) {
    return Split(Wall([=](double x_m) { return x_m < 6 || x_m > 7 ? std::nan("")
                                               : x_m < 6.1        ? left_m
                                               : x_m > 6.9        ? right_m
                                                                  : 0; }, 200,
                      0.02),
                 0.02)
        .at(0);
  };
  const Segment upright = pier(0, 0), between = pier(0.006, -0.006);
  EXPECT_LT(std::abs(upright.plane.n.x()), 0.001);
  EXPECT_LT(std::abs(between.plane.n.x()), 0.001);
  EXPECT_EQ(between.cells.size(), 200u) << "they are the wall's all the same";
}

// A pillar before a window in deep reveals: three faces, two of them seen edge on and too narrow to be planes, under a plane that leans
// over all of them. `across_m`: how far the reveals reach back.
std::vector<Segment> Reveals(double across_m) {
  return Split(
      Wall([=](double x_m) { return x_m < 6 || x_m > 6.6 ? std::nan("") : across_m * (std::fmod(x_m, 0.3) / 0.3 - 0.5); }, 20, 0.02), 0.02);
}
TEST(SplitCells, NarrowFacesOneAfterTheOtherAreNoPlane) {
  EXPECT_EQ(Reveals(0).size(), 1u);
  EXPECT_TRUE(Reveals(0.08).empty());
}

// Its facets bend by 8 mm, rms, and more.
TEST(SplitCells, AFacetOfARoundColumnIsOne) {
  const auto column = [](double x_m) { return std::abs(x_m - 4) > 0.45 ? std::nan("") : 0.8 * (x_m - 4) * (x_m - 4); };
  EXPECT_FALSE(Split(Wall(column, 20, 0.02), 0.02).empty());
}

// Where the scan's lines are far apart, most cells have none beside them: then all of them tell the plane.
TEST(SplitCells, FewCellsAllTellThePlane) {
  std::vector<CellStats> cells = Wall([](double) { return 0; }, 50, 0.01), sparse;
  for (size_t i = 0; i < cells.size(); ++i) {
    if (i / 20 % 2 == 0) sparse.push_back(cells[i]);
  }
  const std::vector<Segment> segments = Split(sparse, 0.01);
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_EQ(segments[0].stats.count(), 50.0 * static_cast<double>(sparse.size()));
}

// How far along a segment's cells reach.
std::pair<float, float> Reach(const Segment& segment) {
  const auto [lo, hi] = std::minmax_element(segment.cells.begin(), segment.cells.end(),
                                            [](const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return a.x() < b.x(); });
  return {lo->x(), hi->x()};
}

// Parts of it are off the plane that fits it best, more than noise explains: facets at its ends, but no wall before the wall.
TEST(SplitCells, MakesNoWallBeforeOneThatBows) {
  constexpr double kOn_m = 2.5 * 0.03 / 2.236;  // a mean of five points
  for (unsigned seed = 0; seed < 30; ++seed) {
    const auto bow = [](double x_m) { return 0.03 * (1 - (x_m - 4) * (x_m - 4) / 16); };
    const std::vector<Segment> segments = Split(Wall(bow, 5, 0.03, seed), 0.03);
    for (size_t i = 0; i < segments.size(); ++i) {
      for (size_t k = 0; k < i; ++k) {
        const auto [from, to] = Reach(segments[k]);
        const auto within = std::count_if(segments[i].cells.begin(), segments[i].cells.end(), [&, from = from, to = to](const auto& cell) {
          const double off_m = segments[k].plane.SignedDistance(cell.template cast<double>());
          return cell.x() >= from && cell.x() <= to && std::abs(off_m) < kOn_m;
        });
        EXPECT_LE(2 * static_cast<size_t>(within), segments[i].cells.size()) << seed;
      }
    }
  }
}

}  // namespace
}  // namespace plumb::runtime
