#include "runtime/optimization/built_tolerance.h"

#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr double kPriorWalls = 2;
constexpr double kLeastRatio = 0.2, kStep = 0.05;
constexpr double kOffsetUnknowns = 3, kYawUnknowns = 1;  // of the frame that the same walls were asked for: x, y, bias; heading

// One number of one wall: its square, the variance of the data alone, and what a ratio of 1 adds to that.
struct Term {
  double square, data_variance, tolerance_variance;
};

double Density(double square, double variance) { return std::exp(-0.5 * square / variance) / std::sqrt(variance); }

// `num` walls stand as planned; the frame was fitted to them, so they are off by less than they stand off.
double MostLikelyRatio(const std::vector<Term>& terms, double num, double num_unknowns, double wide_ratio, double tau1) {
  if (num <= num_unknowns) return 1;
  const double fitted = num / (num - num_unknowns);
  double best = 1, best_cost = 1e300;
  for (double ratio = 1; ratio > kLeastRatio - 0.5 * kStep; ratio -= kStep) {
    const double square = ratio * ratio;
    double cost = 0.5 * kPriorWalls * (std::log(square) + 1 / square);
    for (const Term& t : terms) {
      cost -= std::log((1 - wide_ratio) * Density(fitted * t.square, t.data_variance + square * t.tolerance_variance) +
                       wide_ratio * Density(t.square, t.data_variance + tau1 * tau1));
    }
    if (cost >= best_cost) continue;
    best = ratio;
    best_cost = cost;
  }
  return best;
}

}  // namespace

BuiltTolerance FitBuiltTolerance(const std::vector<WallMeasurement>& measured, const std::vector<WallMeasurement>& at_thickness,
                                 const std::vector<Responsibilities>& responsibilities, double bias_m, const CouplingOptions& options) {
  std::vector<Term> offsets, yaws;
  double num_offsets = 0, num_yaws = 0;
  for (size_t w = 0; w < measured.size(); ++w) {
    const Eigen::Vector2d e = measured[w].At(bias_m).cwiseAbs2(), all = measured[w].covariance.diagonal(),
                          as_thick = at_thickness[w].covariance.diagonal().cwiseMin(all);
    // What poses add is not taken out: it counts as tolerance, which errs on the wide side.
    const Eigen::Vector2d data = as_thick - Eigen::Vector2d(kPoseSigma_m, kPoseSigma_rad).cwiseAbs2();
    const Eigen::Vector2d tolerance = all - as_thick + Eigen::Vector2d(options.offset_tau0_m, options.yaw_tau0_rad).cwiseAbs2();
    offsets.push_back({e.x(), data.x(), tolerance.x()});
    yaws.push_back({e.y(), data.y(), tolerance.y()});
    num_offsets += 1 - responsibilities[w].offset;
    num_yaws += 1 - responsibilities[w].yaw;
  }
  const double wide_ratio = options.deviated_ratio * 2 / 3;  // two of the three deviating cases
  return {MostLikelyRatio(offsets, num_offsets, kOffsetUnknowns, wide_ratio, options.offset_tau1_m),
          MostLikelyRatio(yaws, num_yaws, kYawUnknowns, wide_ratio, options.yaw_tau1_rad)};
}

}  // namespace plumb::runtime
