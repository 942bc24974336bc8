#include "runtime/coupling/mixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb::runtime {
namespace {

const Eigen::Matrix2d kPrecise = Eigen::Vector2d(1e-6, 1e-6).asDiagonal();

TEST(Mixture, OffsetAndYawDeviateEachOnTheirOwn) {
  const Responsibilities none = AssessMixture({0.002, 0.001}, kPrecise, {});
  EXPECT_LT(none.any, 0.05);
  const Responsibilities offset = AssessMixture({0.15, 0.001}, kPrecise, {});
  EXPECT_GT(offset.offset, 0.999);
  EXPECT_LT(offset.yaw, 0.1);
  EXPECT_GT(offset.any, 0.999);
  const Responsibilities yaw = AssessMixture({0.002, 0.08}, kPrecise, {});
  EXPECT_LT(yaw.offset, 0.1);
  EXPECT_GT(yaw.yaw, 0.999);
}

TEST(Mixture, DensityIntegratesToOne) {
  const Eigen::Matrix2d cov = Eigen::Vector2d(1e-4, 1e-4).asDiagonal();
  double sum = 0;
  constexpr double kStep = 0.004;
  for (double x = -1.2; x < 1.2; x += kStep) {
    for (double y = -0.9; y < 0.9; y += kStep) sum += std::exp(-AssessMixture({x, y}, cov, {}).cost_nats) * kStep * kStep;
  }
  EXPECT_NEAR(sum, 1, 0.01);
}

TEST(Mixture, AVagueMeasurementLeavesThePrior) {
  const Responsibilities r = AssessMixture({0, 0}, Eigen::Matrix2d::Identity() * 100, {});
  EXPECT_NEAR(r.any, CouplingOptions{}.deviated_ratio, 0.01);
}

TEST(Mixture, PriorInformationRunsFromTightToWide) {
  const CouplingOptions options;
  EXPECT_DOUBLE_EQ(PriorInformation({0, 0, 0, 0}, options).x(), 1 / (options.offset_tau0_m * options.offset_tau0_m));
  EXPECT_DOUBLE_EQ(PriorInformation({1, 1, 1, 0}, options).y(), 1 / (options.yaw_tau1_rad * options.yaw_tau1_rad));
}

// Seen at an end, 2 m from the middle, 15 cm off: it moved or it turned.
TEST(Mixture, APriorThatFreesTheOtherOfTwoIsAnotherOne) {
  const Responsibilities moved{.offset = 0.505, .yaw = 0.495, .any = 1, .cost_nats = 0, .offset_is_wide = true, .yaw_is_wide = false};
  Responsibilities turned = moved;
  EXPECT_EQ(PriorChange(moved, turned), 0);
  turned.offset = 0.5;
  EXPECT_NEAR(PriorChange(moved, turned), 0.005, 1e-12);
  turned.offset_is_wide = false;
  turned.yaw_is_wide = true;
  EXPECT_EQ(PriorChange(moved, turned), 1);
  Responsibilities standing = moved, also = turned;
  standing.any = also.any = 1e-4;
  standing.offset = standing.yaw = also.offset = also.yaw = 1e-4;
  EXPECT_NEAR(PriorChange(standing, also), 1e-4, 1e-12);
}

TEST(Mixture, AWallThatDeviatesInOneOfTwoWaysIsHeldInTheOtherAlone) {
  const CouplingOptions options;
  constexpr double kArm_m = 2, kOff_m = 0.15, kTurn_rad = 0.035, kSigma_m = 0.005, kSigma_rad = 0.03;
  Eigen::Matrix2d covariance;
  covariance << kSigma_m * kSigma_m + kArm_m * kArm_m * kSigma_rad * kSigma_rad, -kArm_m * kSigma_rad * kSigma_rad,
      -kArm_m * kSigma_rad * kSigma_rad, kSigma_rad * kSigma_rad;
  const Responsibilities r = AssessMixture({kOff_m - kArm_m * kTurn_rad, kTurn_rad}, covariance, options);
  ASSERT_GT(r.any, 0.999);
  ASSERT_LT(std::max(r.offset, r.yaw), 0.95) << "or there would be no doubt";
  const Eigen::Vector2d information = PriorInformation(r, options);
  EXPECT_LT(information.x(), 2 / (options.offset_tau1_m * options.offset_tau1_m) + 1e-3 / (options.offset_tau0_m * options.offset_tau0_m));
}

}  // namespace
}  // namespace plumb::runtime
