// Per-point times as drivers write them (seconds to nanoseconds, from the sweep's start or absolute) as seconds after the stamp.
#pragma once

#include <string_view>
#include <vector>

namespace plumb::runtime {

struct PointTimeField {
  std::string_view name;
  bool floating = true;  // the field's type is a float
  bool wide = false;     // ... of eight bytes
};

// The unit follows from how long the values span, as a sweep lasts between 5 ms and 5 s; integers are nanoseconds or microseconds.
// Values that cannot be offsets within a sweep are absolute: taken from `stamp_s` if that is on the same clock (within 10 s), else
// from the earliest point. `values` must be finite.
[[nodiscard]] std::vector<float> PointTimesAfterStamp(const std::vector<double>& values, const PointTimeField& field, double stamp_s);

}  // namespace plumb::runtime
