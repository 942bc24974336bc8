#include "runtime/optimization/wall_posterior.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "tests/support/random.h"

namespace plumb::runtime {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

const std::vector<MeasuredElsewhere> kHere{{1.0, Vector2d::Zero()}};

Matrix2d Diagonal(double sigma_m, double sigma_rad) { return Vector2d(sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal(); }

// What the M step makes of a measurement.
Vector2d Shrunk(const WallEvidence& e, const CouplingOptions& options) {
  const Vector2d prior = PriorInformation(AssessMixture(e.measured, e.covariance, options), options);
  Matrix2d information = e.covariance.inverse();
  const Vector2d pull = information * e.measured;
  information.diagonal() += prior;
  return information.inverse() * pull;
}

TEST(WallPosterior, TakesThePriorOut) {
  const CouplingOptions options;
  const WallEvidence truth{{0.12, 0.01}, Diagonal(0.01, 0.002)};
  const Vector2d prior(1 / (0.005 * 0.005), 1 / (0.0035 * 0.0035));
  Matrix2d information = truth.covariance.inverse();
  information.diagonal() += prior;
  const Matrix2d posterior = information.inverse();
  const WallEvidence out = WithoutPrior(posterior * truth.covariance.inverse() * truth.measured, posterior, prior, options);
  EXPECT_LT((out.measured - truth.measured).norm(), 1e-3);
  EXPECT_NEAR(std::sqrt(out.covariance(0, 0)), 0.01, 1e-4);
  // Of a wall that nothing was seen of, the posterior is the prior.
  const WallEvidence nothing = WithoutPrior(Vector2d::Zero(), prior.cwiseInverse().asDiagonal(), prior, options);
  EXPECT_GT(std::sqrt(nothing.covariance(0, 0)), 5 * options.offset_tau1_m);
}

TEST(WallPosterior, StrongEvidenceHasTheSigmaOfItsComponent) {
  const CouplingOptions options;
  const WallEvidence as_planned{{0.001, 0}, Diagonal(0.005, 0.001)}, deviated{{0.3, 0}, Diagonal(0.005, 0.001)};
  EXPECT_NEAR(BeliefOf(as_planned, kHere, Shrunk(as_planned, options), options).sigma.x(), 0.005 / std::sqrt(2.0), 5e-4);
  const WallBelief found = BeliefOf(deviated, kHere, Shrunk(deviated, options), options);
  EXPECT_NEAR(found.sigma.x(), 0.005, 2e-4);
  EXPECT_GT(found.p_deviated, 0.999);
}

TEST(WallPosterior, WeakEvidenceIsNotAsSureAsTheTightPrior) {
  const CouplingOptions options;
  const WallEvidence weak{{0.14, 0}, Diagonal(0.08, 0.009)};
  const Vector2d estimate = Shrunk(weak, options);
  EXPECT_LT(estimate.x(), 0.01) << "held by the tight prior";
  const WallBelief belief = BeliefOf(weak, kHere, estimate, options);
  EXPECT_GT(2 * belief.sigma.x(), 0.10);
  EXPECT_NEAR(belief.p_deviated, options.deviated_ratio, 0.1) << "next to nothing learned";
}

TEST(WallPosterior, AnEvenBetOnWhereThePlanLiesIsOneOnTheWall) {
  const CouplingOptions options;
  const WallEvidence sharp{{0, 0}, Diagonal(0.004, 0.001)};
  const WallBelief belief = BeliefOf(sharp, {{0.5, Vector2d::Zero()}, {0.5, Vector2d(0.3, 0)}}, Vector2d::Zero(), options);
  EXPECT_NEAR(belief.p_deviated, 0.5, 0.03);
  EXPECT_NEAR(2 * belief.sigma.x(), 0.3, 0.01);
}

TEST(WallPosterior, TwoSigmaCoverWallsDrawnFromThePriorHoweverWellSeen) {
  const CouplingOptions options;
  test::Random random(11);
  for (const double sigma_m : {0.003, 0.01, 0.03, 0.08, 0.2}) {
    const double sigma_rad = 0.1 * sigma_m;
    int inside = 0;
    constexpr int kTrials = 4000;
    for (int i = 0; i < kTrials; ++i) {
      Vector2d tau(options.offset_tau0_m, options.yaw_tau0_rad);
      if (const double u = random.Uniform(0, 1); u < options.deviated_ratio) {
        const int k = 1 + static_cast<int>(3 * u / options.deviated_ratio);
        if (k >= 2) tau.x() = options.offset_tau1_m;
        if (k != 2) tau.y() = options.yaw_tau1_rad;
      }
      const Vector2d truth(random.Normal(tau.x()), random.Normal(tau.y()));
      const WallEvidence seen{truth + Vector2d(random.Normal(sigma_m), random.Normal(sigma_rad)), Diagonal(sigma_m, sigma_rad)};
      const Vector2d estimate = Shrunk(seen, options);
      inside += std::abs(estimate.x() - truth.x()) <= 2 * BeliefOf(seen, kHere, estimate, options).sigma.x();
    }
    EXPECT_NEAR(static_cast<double>(inside) / kTrials, 0.95, 0.02) << sigma_m;
  }
}

}  // namespace
}  // namespace plumb::runtime
