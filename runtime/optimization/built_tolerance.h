// How true to its plan a building was built, told by the walls that stand as planned.
#pragma once

#include <vector>

#include "runtime/coupling/mixture.h"
#include "runtime/optimization/wall_measurement.h"

namespace plumb::runtime {

// Shares of the tolerances that the options allow for, in (0, 1].
struct BuiltTolerance {
  double offset_ratio = 1;  // of offset_tau0_m and thickness_sigma_m
  double yaw_ratio = 1;     // of yaw_tau0_rad
};

// The ratios that make the measured deviations most likely under the mixture, with a prior of two walls that are off by the whole
// tolerance: with few walls it stays what the options say. `at_thickness` are the same measurements as if no wall could be thicker than
// planned, `responsibilities` how many walls the frame rests on; all three in the same order. O(walls).
[[nodiscard]] BuiltTolerance FitBuiltTolerance(const std::vector<WallMeasurement>& measured,
                                               const std::vector<WallMeasurement>& at_thickness,
                                               const std::vector<Responsibilities>& responsibilities, double bias_m,
                                               const CouplingOptions& options);

}  // namespace plumb::runtime
