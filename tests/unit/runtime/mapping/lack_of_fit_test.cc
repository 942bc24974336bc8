#include "runtime/mapping/lack_of_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

namespace plumb::runtime {
namespace {

constexpr double kNoise_m = 0.02;

// Of cells of 0.1 m x 0.1 m with so many points each, `length_m` along x and 1 m high, `depth` behind the plane y = 0 that is seen from
// smaller y; the plane may be turned and shifted with all of them.
LackOfFit Of(const std::function<double(double x_m)>& depth, double length_m, int cell_points, double yaw_rad = 0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, kNoise_m);
  std::uniform_real_distribution<double> within(-0.05, 0.05);
  const Eigen::Isometry3d T = Eigen::Translation3d(3, -7, 1) * Eigen::Isometry3d(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  std::vector<PlaneStats> cells;
  for (double x_m = 0.05; x_m < length_m; x_m += 0.1) {
    for (double z_m = 0.05; z_m < 1; z_m += 0.1) {
      PlaneStats& cell = cells.emplace_back();
      for (int i = 0; i < cell_points; ++i) {
        const double at_m = x_m + within(random);
        cell.Add(T * Eigen::Vector3d(at_m, depth(at_m) + noise(random), z_m + within(random)));
      }
    }
  }
  const Plane plane = Plane{-Eigen::Vector3d::UnitY(), 0}.Transformed(T);
  return LackOfFitOf(cells, plane, T.linear() * Eigen::Vector3d::UnitX());
}

// The ratio is then spread as F(2 strips - 3, many): under 3 nearly always.
TEST(LackOfFitOf, IsAboutOneForAPlaneWithNoise) {
  double sum = 0, most = 0;
  constexpr int kRuns = 200;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    const double ratio = Of([](double) { return 0; }, 0.6, 5, 0.4, seed).ratio;
    sum += ratio / kRuns;
    most = std::max(most, ratio);
  }
  EXPECT_NEAR(sum, 1, 0.1);
  EXPECT_LT(most, 4.5);
}

TEST(LackOfFitOf, DoesNotHoldAPlanesOwnPlaceLeanOrBendAgainstIt) {
  const auto bent = [](double x_m) { return 0.03 + 0.2 * x_m + 0.5 * x_m * x_m; };
  EXPECT_NEAR(Of(bent, 0.6, 20, 1.1).ratio, 1, 0.9);
  EXPECT_LT(Of(bent, 0.6, 20, 1.1).rms_m, 0.003);
}

// A saw whose teeth fall by their width: about its line +-5 cm evenly, 29 mm rms, of which none is noise.
TEST(LackOfFitOf, FindsFacesAcrossThePlane) {
  const auto saw = [](double x_m) { return 0.1 * (x_m / 0.1 - std::floor(x_m / 0.1)) - 0.05; };
  const LackOfFit found = Of(saw, 0.8, 20);
  EXPECT_NEAR(found.rms_m, 0.029, 0.003);
  EXPECT_GT(found.ratio, 50);
}

TEST(LackOfFitOf, FindsAStep) {
  const LackOfFit found = Of([](double x_m) { return x_m < 0.4 ? 0.0 : 0.05; }, 0.8, 20);
  EXPECT_GT(found.ratio, 10);
  EXPECT_GT(found.rms_m, 0.008);
  EXPECT_LT(found.rms_m, 0.025);
}

TEST(LackOfFitOf, SaysNothingOfTooLittle) {
  EXPECT_EQ(Of([](double) { return 0; }, 0.1, 50).ratio, 0);
  EXPECT_EQ(LackOfFitOf({}, {}, Eigen::Vector3d::UnitY()).ratio, 0);
}

}  // namespace
}  // namespace plumb::runtime
