// The prior on wall deviations: most walls stand as planned within construction tolerance, some do not; offset and yaw each on their own.
#pragma once

#include <Eigen/Core>
#include <array>

#include "runtime/coupling/coupling.h"

namespace plumb::runtime {

struct Responsibilities {
  double offset = 0, yaw = 0;  // probability that the offset, the yaw comes from the wide component
  double any = 0;              // that at least one of them does: the wall deviates
  double cost_nats = 0;        // -log of the measurement's density under the mixture
  // Of the likeliest of the cases that deviate.
  bool offset_is_wide = true, yaw_is_wide = true;
};

// One case of the mixture, given a measurement.
struct MixtureComponent {
  bool offset_is_wide = false, yaw_is_wide = false, deviates = false;
  double probability = 0, log_density = 0;  // log: of the measurement and this case together
  Eigen::Vector2d prior_variance = Eigen::Vector2d::Zero();
  Eigen::Matrix2d total_covariance = Eigen::Matrix2d::Zero();  // prior and measurement
};
// Their probabilities sum to one. Arguments as AssessMixture().
[[nodiscard]] std::array<MixtureComponent, 4> MixtureComponents(const Eigen::Vector2d& measured, const Eigen::Matrix2d& covariance,
                                                                const CouplingOptions& options);

// Of a measured deviation (offset_m, yaw_rad) with the measurement's covariance, before any prior. Four components: {as planned, deviated}
// for the offset times the same for the yaw; `deviated_ratio` is shared equally by the three that deviate.
[[nodiscard]] Responsibilities AssessMixture(const Eigen::Vector2d& measured, const Eigen::Matrix2d& covariance,
                                             const CouplingOptions& options);

// Inverse prior variances (offset, yaw) given the responsibilities: what the M step weights the deviation with. Expected over standing as
// planned and the likeliest way of deviating. Over all ways, a wall that was seen at one end, moved or turned it does not tell which, would
// have both held at zero, and its views would have no grip on it.
[[nodiscard]] Eigen::Vector2d PriorInformation(const Responsibilities& r, const CouplingOptions& options);

// How much the priors of one E step differ from those of another, 0 to 1: a wall that deviates may change how it does while the
// probabilities hardly move.
[[nodiscard]] double PriorChange(const Responsibilities& before, const Responsibilities& after);

// PriorInformation() of a wall of which nothing is known: inverse variances of the mixture as a whole.
[[nodiscard]] Eigen::Vector2d UniformInformation(const CouplingOptions& options);

}  // namespace plumb::runtime
