#include "runtime/odometry/scan_preparation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace plumb::runtime {
namespace {

// Returns from the wall x = 3 as 16 rings see it, with noise along the beams.
Scan NoisyWall(double sigma_m) {
  std::mt19937_64 engine(7);
  std::normal_distribution<double> noise(0, sigma_m);
  Scan scan;
  for (double azimuth = -0.5; azimuth < 0.5; azimuth += 0.0035) {
    for (int ring = 0; ring < 16; ++ring) {
      const double elevation = 0.035 * (ring - 7.5);
      const Eigen::Vector3d ray(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
      scan.points.push_back(((3 / ray.x() + noise(engine)) * ray).cast<float>());
      scan.time_s.push_back(static_cast<float>(0.1 * (azimuth + 0.5)));
    }
  }
  return scan;
}

double RmsOff_m(const PreparedScan& prepared) {
  double sum_m2 = 0;
  for (const SweepPoint& point : prepared.points) sum_m2 += (point.p.x() - 3) * (point.p.x() - 3);
  return std::sqrt(sum_m2 / static_cast<double>(prepared.points.size()));
}

TEST(PrepareScan, MeansOfAPatchHaveLessNoiseThanItsFirstReturns) {
  const Scan scan = NoisyWall(0.02);
  const PreparedScan first = PrepareScan(scan, 0.1, 0.4, 80), mean = PrepareScan(scan, 0.1, 0.4, 80, 0.1);
  double returns = 0;
  for (const SweepPoint& point : mean.points) returns += point.count;
  EXPECT_GT(returns, 0.95 * static_cast<double>(scan.points.size()));  // the rest lies at the patches' depth gates
  EXPECT_GT(RmsOff_m(first), 0.015);
  EXPECT_LT(RmsOff_m(mean), 1.3 * RmsOff_m(first) / std::sqrt(returns / static_cast<double>(mean.points.size())));
}

Scan TwoReturns(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float later_s) {
  Scan scan;
  scan.points = {a, b, {0, 5, 0}};
  scan.time_s = {0, later_s, 0.1f};
  return scan;
}

TEST(PrepareScan, MixesNoDepthsAndNoTimes) {
  const Eigen::Vector3f near(3.01f, 0.001f, 0.001f), beside(3.03f, 0.002f, 0.002f), behind(3.2f, 0.002f, 0.002f);
  const auto first_of = [](const Scan& scan) { return PrepareScan(scan, 0.1, 0.4, 80, 0.1).points.front(); };
  const SweepPoint mean = first_of(TwoReturns(near, beside, 0.002f));
  EXPECT_EQ(mean.count, 2);
  EXPECT_NEAR(mean.p.x(), 3.02, 1e-6);
  EXPECT_NEAR(mean.s, 0.01, 1e-6);
  EXPECT_EQ(PrepareScan(TwoReturns(near, behind, 0.002f), 0.1, 0.4, 80).points.size(), 2u) << "one patch, and the far point";
  EXPECT_EQ(first_of(TwoReturns(near, behind, 0.002f)).count, 1);
  EXPECT_EQ(first_of(TwoReturns(near, beside, 0.05f)).count, 1);
}

}  // namespace
}  // namespace plumb::runtime
