#include "runtime/optimization/wall_posterior.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace plumb::runtime {
namespace {

constexpr double kTwoSigma = 0.9544997361036416;  // of a normal distribution lies within two standard deviations
constexpr double kLeastInformation = 1e-2;        // of the wide prior's

struct Normal {
  double weight = 0, mean = 0, sigma = 0;
};

// How much of the mixture lies within `reach` of `center`.
double Within(const std::vector<Normal>& mixture, double center, double reach) {
  const auto below = [](double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); };
  double sum = 0;
  for (const Normal& n : mixture) {
    sum += n.weight * (below((center + reach - n.mean) / n.sigma) - below((center - reach - n.mean) / n.sigma));
  }
  return sum;
}

double HalfOfTwoSigma(const std::vector<Normal>& mixture, double center) {
  double high = 0;
  for (const Normal& n : mixture) high = std::max(high, std::abs(n.mean - center) + 10 * n.sigma);
  double low = 0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (Within(mixture, center, middle) < kTwoSigma ? low : high) = middle;
  }
  return 0.5 * high;
}

}  // namespace

WallEvidence WithoutPrior(const Eigen::Vector2d& estimate, const Eigen::Matrix2d& covariance, const Eigen::Vector2d& prior,
                          const CouplingOptions& options) {
  const Eigen::Matrix2d posterior = covariance.inverse();
  Eigen::Matrix2d data = posterior;
  data.diagonal() -= prior;
  data.diagonal() += kLeastInformation * Eigen::Vector2d(options.offset_tau1_m, options.yaw_tau1_rad).cwiseAbs2().cwiseInverse();
  if (!(data(0, 0) > 0 && data.determinant() > 0)) {
    const double wide = 1 / std::sqrt(kLeastInformation);
    return {Eigen::Vector2d::Zero(), (wide * Eigen::Vector2d(options.offset_tau1_m, options.yaw_tau1_rad)).cwiseAbs2().asDiagonal()};
  }
  const Eigen::Matrix2d out = data.inverse();
  return {out * (posterior * estimate), out};
}

WallBelief BeliefOf(const WallEvidence& evidence, const std::vector<MeasuredElsewhere>& places, const Eigen::Vector2d& estimate,
                    const CouplingOptions& options) {
  WallBelief out;
  std::array<std::vector<Normal>, 2> mixtures;
  for (const MeasuredElsewhere& place : places) {
    const Eigen::Vector2d measured = evidence.measured + place.shift;
    for (const MixtureComponent& c : MixtureComponents(measured, evidence.covariance, options)) {
      const double weight = place.probability * c.probability;
      if (c.deviates) out.p_deviated += weight;
      const Eigen::Matrix2d gain = c.prior_variance.asDiagonal() * c.total_covariance.inverse();
      const Eigen::Vector2d mean = gain * measured, variance = c.prior_variance - (gain * c.prior_variance.asDiagonal()).diagonal();
      for (int i = 0; i < 2; ++i) mixtures[i].push_back({weight, mean[i], std::sqrt(std::max(1e-12, variance[i]))});
    }
  }
  for (int i = 0; i < 2; ++i) out.sigma[i] = HalfOfTwoSigma(mixtures[i], estimate[i]);
  return out;
}

}  // namespace plumb::runtime
