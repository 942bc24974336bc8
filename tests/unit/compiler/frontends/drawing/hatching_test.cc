#include "compiler/frontends/drawing/hatching.h"

#include <gtest/gtest.h>

namespace plumb::compiler {
namespace {

// Lines of 5 m beside each other, and long ones that say how large the drawing is.
Drawing Row(size_t count, double spacing_m, LineRole role) {
  Drawing out;
  const auto line = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    DrawnPath path;
    path.role = role;
    path.points = {a, b};
    out.paths.push_back(path);
  };
  for (const double y : {0.0, 10.0, 20.0, 30.0, 40.0}) line({0, y}, {120, y});
  for (size_t i = 0; i < count; ++i) line({spacing_m * static_cast<double>(i), 1}, {spacing_m * static_cast<double>(i), 6});
  return out;
}

TEST(DropHatching, TakesTreadsOut) {
  Drawing stairs = Row(14, 0.28, LineRole::kAny);
  EXPECT_EQ(DropHatching(stairs), 14u);
  EXPECT_EQ(stairs.paths.size(), 5u);
}

TEST(DropHatching, TakesAllThatAPenForHatchingDraws) {
  Drawing drawing = Row(40, 1.0, LineRole::kAny);
  for (size_t i = 5; i < drawing.paths.size(); ++i) drawing.paths[i].layer = 7;
  EXPECT_EQ(DropHatching(drawing), 40u);
}

TEST(DropHatching, LeavesPartitionsThatStandARoomApart) {
  Drawing hotel = Row(40, 3.0, LineRole::kAny);
  EXPECT_EQ(DropHatching(hotel), 0u);
  Drawing stalls = Row(12, 0.95, LineRole::kAny);
  EXPECT_EQ(DropHatching(stalls), 0u);
}

TEST(DropHatching, LeavesWhatIsSaidToBeWalls) {
  Drawing walls = Row(14, 0.28, LineRole::kWall);
  EXPECT_EQ(DropHatching(walls), 0u);
}

}  // namespace
}  // namespace plumb::compiler
