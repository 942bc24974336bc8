#include "runtime/coupling/mixture.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace plumb::runtime {

std::array<MixtureComponent, 4> MixtureComponents(const Eigen::Vector2d& measured, const Eigen::Matrix2d& covariance,
                                                  const CouplingOptions& options) {
  std::array<MixtureComponent, 4> out;
  double highest = -1e300;
  for (size_t k = 0; k < 4; ++k) {
    MixtureComponent& c = out[k];
    c.offset_is_wide = k >= 2;
    c.yaw_is_wide = k % 2 == 1;
    c.deviates = k > 0;
    c.prior_variance = Eigen::Vector2d(c.offset_is_wide ? options.offset_tau1_m : options.offset_tau0_m,
                                       c.yaw_is_wide ? options.yaw_tau1_rad : options.yaw_tau0_rad)
                           .cwiseAbs2();
    c.total_covariance = covariance;
    c.total_covariance.diagonal() += c.prior_variance;
    const double weight = c.deviates ? options.deviated_ratio / 3.0 : 1.0 - options.deviated_ratio;
    const Eigen::Matrix2d& s = c.total_covariance;
    c.log_density =
        std::log(weight) - 0.5 * (measured.dot(s.inverse() * measured) + std::log(s.determinant())) - std::log(2 * std::numbers::pi);
    highest = std::max(highest, c.log_density);
  }
  double sum = 0;
  for (MixtureComponent& c : out) sum += c.probability = std::exp(c.log_density - highest);
  for (MixtureComponent& c : out) c.probability /= sum;
  return out;
}

Responsibilities AssessMixture(const Eigen::Vector2d& measured, const Eigen::Matrix2d& covariance, const CouplingOptions& options) {
  const std::array<MixtureComponent, 4> k = MixtureComponents(measured, covariance, options);
  // Any case gives the density of all of them; the likeliest best.
  const MixtureComponent& best =
      *std::max_element(k.begin(), k.end(), [](const auto& a, const auto& b) { return a.probability < b.probability; });
  const MixtureComponent& way =
      *std::max_element(k.begin() + 1, k.end(), [](const auto& a, const auto& b) { return a.probability < b.probability; });
  return {.offset = k[2].probability + k[3].probability,
          .yaw = k[1].probability + k[3].probability,
          .any = k[1].probability + k[2].probability + k[3].probability,
          .cost_nats = std::log(best.probability) - best.log_density,
          .offset_is_wide = way.offset_is_wide,
          .yaw_is_wide = way.yaw_is_wide};
}

Eigen::Vector2d PriorInformation(const Responsibilities& r, const CouplingOptions& options) {
  const auto expected = [](double wide, double tau0, double tau1) { return (1 - wide) / (tau0 * tau0) + wide / (tau1 * tau1); };
  return {expected(r.offset_is_wide ? r.any : 0, options.offset_tau0_m, options.offset_tau1_m),
          expected(r.yaw_is_wide ? r.any : 0, options.yaw_tau0_rad, options.yaw_tau1_rad)};
}

double PriorChange(const Responsibilities& before, const Responsibilities& after) {
  const bool another_way = before.offset_is_wide != after.offset_is_wide || before.yaw_is_wide != after.yaw_is_wide;
  return std::max({std::abs(after.offset - before.offset), std::abs(after.yaw - before.yaw),
                   another_way ? std::max(before.any, after.any) : std::abs(after.any - before.any)});
}

Eigen::Vector2d UniformInformation(const CouplingOptions& options) {
  const double wide = options.deviated_ratio * 2 / 3;  // of the three cases that deviate, two turn the wall and two move it
  const auto variance = [&](double tau0, double tau1) { return (1 - wide) * tau0 * tau0 + wide * tau1 * tau1; };
  return {1 / variance(options.offset_tau0_m, options.offset_tau1_m), 1 / variance(options.yaw_tau0_rad, options.yaw_tau1_rad)};
}

}  // namespace plumb::runtime
