// How far off odometry may be between two keyframes.
#pragma once

#include <string>

#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// Standard deviations of each axis.
struct StepSigma {
  double m = 0, rad = 0;
};

// Steps err independently of each other.
struct OdometryDrift {
  double sigma_m = 0.005;  // of a step from one keyframe to the next: a constant ...
  double sigma_rad = 0.001;
  double sigma_m_per_m = 0.01;  // ... plus a part that grows with the step's length, ...
  double sigma_rad_per_m = 0.002;
  double sigma_rad_per_rad = 0.01;          // ... turn ...
  double sigma_m_per_s = 0.002;             // ... and duration
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule

  // Grows with the way driven between the two, not only with how far apart they are.
  [[nodiscard]] StepSigma Between(const Keyframe& a, const Keyframe& b) const;
};

}  // namespace plumb::runtime
