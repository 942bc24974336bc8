// What is known of one wall's deviation in the end: over both components of its prior, and over the places where the plan may lie.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "runtime/coupling/mixture.h"

namespace plumb::runtime {

// A wall's deviation (offset_m, yaw_rad) as all data have it, without its own prior.
struct WallEvidence {
  Eigen::Vector2d measured = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

// Takes the wall's own prior, of inverse variances `prior`, out of its posterior. What was hardly seen is told as hardly known, never as
// less than that.
[[nodiscard]] WallEvidence WithoutPrior(const Eigen::Vector2d& estimate, const Eigen::Matrix2d& covariance, const Eigen::Vector2d& prior,
                                        const CouplingOptions& options);

// Were the plan to lie elsewhere, the wall would be measured so much further off. Probabilities sum to one over all places.
struct MeasuredElsewhere {
  double probability = 0;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
};

struct WallBelief {
  double p_deviated = 0;
  // Half of what the wall lies within of its estimate, either way, with 95.45 %: of a normal distribution the standard deviation.
  Eigen::Vector2d sigma = Eigen::Vector2d::Zero();  // offset_m, yaw_rad
};
[[nodiscard]] WallBelief BeliefOf(const WallEvidence& evidence, const std::vector<MeasuredElsewhere>& places,
                                  const Eigen::Vector2d& estimate, const CouplingOptions& options);

}  // namespace plumb::runtime
