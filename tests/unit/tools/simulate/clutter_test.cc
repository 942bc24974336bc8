#include "tools/simulate/clutter.h"

#include <gtest/gtest.h>

#include "tests/support/house.h"

namespace plumb::tools {
namespace {

TEST(Clutter, StandsOnTheFloorAndBlocksNoRoom) {
  SimulateOptions options;
  options.deviate = 0;
  AsBuilt built = *BuildWithDeviations(test::MakeHouse(), StoreyId(0), options);
  const size_t elements = built.house.elements.size();
  const int placed = AddClutter(built, StoreyId(0), 8, 3);
  EXPECT_GE(placed, 5);
  EXPECT_EQ(built.house.elements.size(), elements + static_cast<size_t>(placed));
  EXPECT_EQ(FindReach(built.house, StoreyId(0), FreeSpace(built.house, StoreyId(0), built.passages)).reachable(), 3u);
  for (const Triangle& t : built.house.mesh.triangles) {
    if (t.element < elements) continue;
    const float z = built.house.mesh.vertices[t.a].z();
    EXPECT_TRUE(z == 0.0f || (z >= 0.4f && z <= 1.8f)) << z;
  }
}

}  // namespace
}  // namespace plumb::tools
