#include "runtime/sources/point_time.h"

#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr double kLongestSweep_s = 5;
constexpr double kLongestOffset_s = 1;     // larger values are no offsets from the start or end of a sweep
constexpr double kSameClock_s = 10;

double UnitInSeconds(double span, bool floating) {
  if (floating && span < kLongestSweep_s) return 1;
  if (floating && span < kLongestSweep_s * 1e3) return 1e-3;
  if (span < kLongestSweep_s * 1e6) return 1e-6;
  return 1e-9;
}

}  // namespace

std::vector<float> PointTimesAfterStamp(const std::vector<double>& values, const PointTimeField& field, double stamp_s) {
  if (values.empty()) return {};
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  double unit_s = UnitInSeconds(*max - *min, field.floating);
  // All points at one time tell no unit: integers are then nanoseconds, as most drivers have it.
  if (*max == *min && !field.floating) unit_s = 1e-9;
  const double first_s = *min * unit_s;
  const bool named_absolute = field.wide && field.name == "timestamp" && std::abs(first_s - stamp_s) < std::abs(first_s);
  const bool absolute = named_absolute || std::abs(first_s) > kLongestOffset_s;
  double zero_s = 0;
  if (absolute) zero_s = std::abs(first_s - stamp_s) < kSameClock_s ? stamp_s : first_s;
  std::vector<float> times_s(values.size());
  // Differences in the source's own unit first: absolute nanoseconds leave no digits otherwise.
  for (size_t i = 0; i < values.size(); ++i) times_s[i] = static_cast<float>((values[i] - *min) * unit_s + (first_s - zero_s));
  return times_s;
}

}  // namespace plumb::runtime
