#include "runtime/numerics/distance_transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::runtime {
namespace {

TEST(SquaredCellDistances, AreThoseToTheNearestMarkedCell) {
  constexpr size_t kWidth = 37, kHeight = 23;
  std::vector<uint8_t> marked(kWidth * kHeight);
  for (const size_t i : {5u, 40u, 41u, 333u, 700u, 849u}) marked[i] = 1;
  const std::vector<float> squared = SquaredCellDistances(marked, kWidth);
  for (size_t i = 0; i < marked.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < marked.size(); ++k) {
      if (marked[k] == 0) continue;
      const double dx = static_cast<double>(i % kWidth) - static_cast<double>(k % kWidth),
                   dy = static_cast<double>(i / kWidth) - static_cast<double>(k / kWidth);
      nearest = std::min(nearest, dx * dx + dy * dy);
    }
    EXPECT_EQ(static_cast<double>(squared[i]), nearest) << i;
  }
}

TEST(SquaredCellDistances, AreInfiniteWhereNothingIsMarked) {
  for (const float d : SquaredCellDistances(std::vector<uint8_t>(12), 4)) EXPECT_TRUE(std::isinf(d));
  EXPECT_TRUE(SquaredCellDistances({}, 4).empty());
}

}  // namespace
}  // namespace plumb::runtime
