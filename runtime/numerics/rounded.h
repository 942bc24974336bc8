// Numbers as they are written for other programs.
#pragma once

#include <cmath>

namespace plumb::runtime {

// To the nearest 1 / per_unit; never -0, so that equal results have equal text.
[[nodiscard]] inline double Rounded(double value, double per_unit) {
  const double rounded = std::round(value * per_unit) / per_unit;
  return rounded == 0 ? 0 : rounded;
}

}  // namespace plumb::runtime
