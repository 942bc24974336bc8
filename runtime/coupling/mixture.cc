#include "runtime/coupling/mixture.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace plumb::runtime {

Responsibilities AssessMixture(const Eigen::Vector2d& measured, const Eigen::Matrix2d& covariance, const CouplingOptions& options) {
  const std::array<double, 2> offset_tau{options.offset_tau0_m, options.offset_tau1_m}, yaw_tau{options.yaw_tau0_rad, options.yaw_tau1_rad};
  std::array<double, 4> log_p{};  // index: 2 * (offset is wide) + (yaw is wide)
  for (size_t k = 0; k < 4; ++k) {
    Eigen::Matrix2d s = covariance;
    s(0, 0) += offset_tau[k >> 1] * offset_tau[k >> 1];
    s(1, 1) += yaw_tau[k & 1] * yaw_tau[k & 1];
    const double weight = k == 0 ? 1.0 - options.deviated_ratio : options.deviated_ratio / 3.0;
    log_p[k] = std::log(weight) - 0.5 * (measured.dot(s.inverse() * measured) + std::log(s.determinant())) - std::log(2 * std::numbers::pi);
  }
  const double highest = *std::max_element(log_p.begin(), log_p.end());
  std::array<double, 4> p{};
  double sum = 0;
  for (size_t k = 0; k < 4; ++k) sum += p[k] = std::exp(log_p[k] - highest);
  return {(p[2] + p[3]) / sum, (p[1] + p[3]) / sum, (p[1] + p[2] + p[3]) / sum, -(highest + std::log(sum))};
}

Eigen::Vector2d PriorInformation(const Responsibilities& r, const CouplingOptions& options) {
  const auto expected = [](double wide, double tau0, double tau1) { return (1 - wide) / (tau0 * tau0) + wide / (tau1 * tau1); };
  return {expected(r.offset, options.offset_tau0_m, options.offset_tau1_m), expected(r.yaw, options.yaw_tau0_rad, options.yaw_tau1_rad)};
}

Eigen::Vector2d UniformInformation(const CouplingOptions& options) {
  const double wide = options.deviated_ratio * 2 / 3;  // of the three cases that deviate, two turn the wall and two move it
  const auto variance = [&](double tau0, double tau1) { return (1 - wide) * tau0 * tau0 + wide * tau1 * tau1; };
  return {1 / variance(options.offset_tau0_m, options.offset_tau1_m), 1 / variance(options.yaw_tau0_rad, options.yaw_tau1_rad)};
}

}  // namespace plumb::runtime
