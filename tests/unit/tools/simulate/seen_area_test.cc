#include "tools/simulate/seen_area.h"

#include <gtest/gtest.h>

namespace plumb::tools {
namespace {

TEST(SeenArea, CountsCellsThatThreeReturnsCameFrom) {
  const SurfaceHit left{SurfaceId(0), -0.05, 1.02}, right{SurfaceId(0), 0.05, 1.02}, above{SurfaceId(0), 0.05, 1.13},
      other{SurfaceId(2), 0.05, 1.02};
  SeenArea seen;
  seen.Add({left, right, above, other, {}});
  seen.Add({left, right, above, other, {}});
  EXPECT_EQ(seen.PerSurface_m2(3), std::vector<double>(3, 0));
  seen.Add({left, right, other, {}});
  for (int i = 0; i < 300; ++i) seen.Add({right});
  const std::vector<double> areas_m2 = seen.PerSurface_m2(3);
  EXPECT_NEAR(areas_m2[0], 0.02, 1e-12);
  EXPECT_EQ(areas_m2[1], 0);
  EXPECT_NEAR(areas_m2[2], 0.01, 1e-12);
}

}  // namespace
}  // namespace plumb::tools
