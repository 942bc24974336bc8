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
  double weight, square, data_variance, tolerance_variance;
};

double MostLikelyRatio(const std::vector<Term>& terms, double num_unknowns) {
  double num = 0;
  for (const Term& t : terms) num += t.weight;
  if (num <= num_unknowns) return 1;
  const double free_share = (num - num_unknowns) / num;  // the frame was fitted to these walls: they are off by less than they stand off
  double best = 1, best_cost = 1e300;
  for (double ratio = 1; ratio > kLeastRatio - 0.5 * kStep; ratio -= kStep) {
    const double square = ratio * ratio;
    double cost = kPriorWalls * (std::log(square) + 1 / square);
    for (const Term& t : terms) {
      const double variance = t.data_variance + square * t.tolerance_variance;
      cost += t.weight * (free_share * std::log(variance) + t.square / variance);
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
  for (size_t w = 0; w < measured.size(); ++w) {
    const Eigen::Vector2d e = measured[w].At(bias_m).cwiseAbs2(), all = measured[w].covariance.diagonal();
    // What poses add is not taken out: it counts as tolerance, which errs on the wide side.
    const Eigen::Vector2d data =
        at_thickness[w].covariance.diagonal().cwiseMin(all) - Eigen::Vector2d(kPoseSigma_m, kPoseSigma_rad).cwiseAbs2();
    const Eigen::Vector2d tolerance = all - at_thickness[w].covariance.diagonal().cwiseMin(all) +
                                      Eigen::Vector2d(options.offset_tau0_m, options.yaw_tau0_rad).cwiseAbs2();
    offsets.push_back({1 - responsibilities[w].offset, e.x(), data.x(), tolerance.x()});
    yaws.push_back({1 - responsibilities[w].yaw, e.y(), data.y(), tolerance.y()});
  }
  return {MostLikelyRatio(offsets, kOffsetUnknowns), MostLikelyRatio(yaws, kYawUnknowns)};
}

}  // namespace plumb::runtime
