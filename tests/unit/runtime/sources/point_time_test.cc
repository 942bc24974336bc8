#include "runtime/sources/point_time.h"

#include <gtest/gtest.h>

namespace plumb::runtime {
namespace {

constexpr double kStamp_s = 1630577758.5;

// A sweep of 0.1 s in five steps, in the given unit, from `first`.
std::vector<double> Sweep(double first, double units_per_s) {
  std::vector<double> values;
  for (int i = 0; i < 5; ++i) values.push_back(first + 0.02 * i * units_per_s);
  return values;
}

void ExpectSweep(const std::vector<float>& times_s, float first_s = 0) {
  ASSERT_EQ(times_s.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(times_s[static_cast<size_t>(i)], first_s + 0.02f * static_cast<float>(i), 1e-6f);
}

TEST(PointTime, TakesTheUnitFromTheSpan) {
  ExpectSweep(PointTimesAfterStamp(Sweep(0, 1), {"time", true, false}, kStamp_s));
  ExpectSweep(PointTimesAfterStamp(Sweep(0, 1e3), {"time", true, false}, kStamp_s));
  ExpectSweep(PointTimesAfterStamp(Sweep(0, 1e6), {"time", true, false}, kStamp_s));
  ExpectSweep(PointTimesAfterStamp(Sweep(0, 1e9), {"t", false, false}, kStamp_s));
  ExpectSweep(PointTimesAfterStamp(Sweep(0, 1e6), {"t", false, false}, kStamp_s));
}

TEST(PointTime, KeepsOffsetsFromTheSweepsEnd) {
  ExpectSweep(PointTimesAfterStamp(Sweep(-0.1, 1), {"time", true, false}, kStamp_s), -0.1f);
}

TEST(PointTime, MakesAbsoluteStampsRelative) {
  const std::vector<float> times_s = PointTimesAfterStamp(Sweep(kStamp_s + 0.25, 1), {"timestamp", true, true}, kStamp_s);
  ExpectSweep(times_s, 0.25f);
  // Another clock than the scan's stamp: from the earliest point.
  ExpectSweep(PointTimesAfterStamp(Sweep(4711.5, 1), {"timestamp", true, true}, kStamp_s));
  ExpectSweep(PointTimesAfterStamp(Sweep(4711.5e9, 1e9), {"t", false, true}, kStamp_s));
  // A recording that starts at zero: the name tells.
  ExpectSweep(PointTimesAfterStamp(Sweep(0.3, 1), {"timestamp", true, true}, 0.3));
  ExpectSweep(PointTimesAfterStamp(Sweep(0.3, 1), {"time", true, false}, 0.3), 0.3f);
}

TEST(PointTime, GivesNothingForNothing) {
  EXPECT_TRUE(PointTimesAfterStamp({}, {"time", true, false}, kStamp_s).empty());
  EXPECT_EQ(PointTimesAfterStamp({0, 0}, {"t", false, false}, kStamp_s), (std::vector<float>{0, 0}));
}

}  // namespace
}  // namespace plumb::runtime
