#include "compiler/geometry/stitch.h"

#include <gtest/gtest.h>

namespace plumb::compiler {
namespace {

// A unit cube whose top is two rectangles: their common edge ends inside edges of two sides.
TEST(StitchPolygons, CornersOnEdgesBecomeCornersThere) {
  const std::vector<Ring3> faces = {
      {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}},     {{0, 0, 1}, {0.3, 0, 1}, {0.3, 1, 1}, {0, 1, 1}},
      {{0.3, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0.3, 1, 1}}, {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}},
      {{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}},     {{1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {1, 1, 1}},
      {{0, 1, 0}, {0, 0, 0}, {0, 0, 1}, {0, 1, 1}},
  };
  const Solid cube = StitchPolygons(faces, 1e-6);
  EXPECT_EQ(cube.vertices.size(), 10u);
  EXPECT_TRUE(IsClosed(cube));
  EXPECT_NEAR(Volume(cube), 1, 1e-12);
}

TEST(StitchPolygons, CornersCloseToAnEdgeCount) {
  const std::vector<Ring3> faces = {
      {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}},     {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
      {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}},     {{1, 0, 0}, {0, 1, 0}, {0.5, 0.5 + 3e-7, 3e-7}},
      {{0.5, 0.5, 0}, {0, 1, 0}, {0, 0, 1}}, {{1, 0, 0}, {0.5, 0.5, 0}, {0, 0, 1}},
  };
  EXPECT_TRUE(IsClosed(StitchPolygons(faces, 2e-6)));
}

}  // namespace
}  // namespace plumb::compiler
