#include "tools/simulate/random.h"

#include <gtest/gtest.h>

namespace plumb::tools {
namespace {

TEST(Random, RepeatsWithItsSeedAndStream) {
  Random a(1, 2), b(1, 2), c(1, 3), d(2, 2);
  const uint64_t first = a.Next();
  EXPECT_EQ(first, b.Next());
  EXPECT_NE(first, c.Next());
  EXPECT_NE(first, d.Next());
}

TEST(Random, HasTheMomentsOfItsDistributions) {
  Random random(7);
  double sum = 0, squares = 0, uniform = 0, tails = 0;
  constexpr int kDraws = 200000;
  for (int i = 0; i < kDraws; ++i) {
    const double n = random.Normal(), u = random.Uniform(2, 4);
    sum += n;
    squares += n * n;
    tails += std::abs(n) > 2 ? 1 : 0;
    uniform += u;
    ASSERT_TRUE(u >= 2 && u < 4);
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.01);
  EXPECT_NEAR(squares / kDraws, 1, 0.02);
  EXPECT_NEAR(tails / kDraws, 0.0455, 0.002);
  EXPECT_NEAR(uniform / kDraws, 3, 0.01);
}

}  // namespace
}  // namespace plumb::tools
