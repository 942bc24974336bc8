#include "runtime/optimization/built_tolerance.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace plumb::runtime {
namespace {

// Walls as planned that are off by `share` of the tolerance, each measured to 1 mm and 0.5 mrad, half of the offset's tolerance (in
// variance) being the wall's thickness; every sixth deviates.
BuiltTolerance Fit(size_t num_walls, double share, uint64_t seed = 1) {
  const CouplingOptions options;
  test::Random random(seed);
  std::vector<WallMeasurement> all, at_thickness;
  std::vector<Responsibilities> responsibilities;
  const double thickness_m2 = options.offset_tau0_m * options.offset_tau0_m;
  for (size_t w = 0; w < num_walls; ++w) {
    const bool deviates = w % 6 == 5;
    WallMeasurement m;
    m.bias_gain = Eigen::Vector2d::Zero();
    m.deviation = {random.Normal(std::hypot(0.001, share * std::sqrt(2 * thickness_m2))) + (deviates ? 0.2 : 0),
                   random.Normal(std::hypot(0.0005, share * options.yaw_tau0_rad))};
    m.covariance = Eigen::Vector2d(1e-6 + kPoseSigma_m * kPoseSigma_m, 25e-8 + kPoseSigma_rad * kPoseSigma_rad).asDiagonal();
    at_thickness.push_back(m);
    m.covariance(0, 0) += thickness_m2;
    all.push_back(m);
    responsibilities.push_back({deviates ? 1.0 : 0.0, 0, deviates ? 1.0 : 0.0, 0});
  }
  return FitBuiltTolerance(all, at_thickness, responsibilities, 0, options);
}

TEST(FitBuiltTolerance, FewWallsSayNothingAndManyTrueOnesALot) {
  EXPECT_EQ(Fit(3, 0).offset_ratio, 1);
  EXPECT_GT(Fit(9, 0).offset_ratio, 0.35);
  EXPECT_LT(Fit(9, 0).offset_ratio, 0.75);
  EXPECT_LT(Fit(60, 0).offset_ratio, 0.35);
  EXPECT_LT(Fit(60, 0).yaw_ratio, 0.35);
}

TEST(FitBuiltTolerance, FindsHowFarWallsAreOffOnAverage) {
  for (const double share : {0.5, 0.8, 1.0}) {
    double offset = 0, yaw = 0;
    for (uint64_t seed = 1; seed <= 20; ++seed) {
      const BuiltTolerance built = Fit(60, share, seed);
      offset += built.offset_ratio / 20;
      yaw += built.yaw_ratio / 20;
    }
    EXPECT_NEAR(offset, share, 0.1);
    EXPECT_NEAR(yaw, share, 0.1);
  }
}

TEST(FitBuiltTolerance, AWallThatDeviatesByLittleIsNoToleranceOfTheOthers) {
  const CouplingOptions options;
  std::vector<WallMeasurement> measured;
  for (int w = 0; w < 20; ++w) {
    WallMeasurement m;
    m.bias_gain = Eigen::Vector2d::Zero();
    m.deviation = {w % 5 == 0 ? 0.03 : 0.0005, 0};
    m.covariance = Eigen::Vector2d(1e-6 + kPoseSigma_m * kPoseSigma_m, 25e-8 + kPoseSigma_rad * kPoseSigma_rad).asDiagonal();
    measured.push_back(m);
  }
  EXPECT_LT(FitBuiltTolerance(measured, measured, std::vector<Responsibilities>(20), 0, options).offset_ratio, 0.6);
}

TEST(FitBuiltTolerance, NeverMoreThanTheOptionsAllow) {
  EXPECT_EQ(Fit(60, 2).offset_ratio, 1);
  EXPECT_EQ(Fit(60, 2).yaw_ratio, 1);
}

}  // namespace
}  // namespace plumb::runtime
