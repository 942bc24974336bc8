#include "compiler/geometry/door_swings.h"

#include <gtest/gtest.h>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

TEST(LeafOfSwing, TellsJambAndSideWhicheverWayTheArcRuns) {
  const Vector2d hinge(0.5, 0.1), closed(-0.4, 0.1), open(0.5, -0.8);
  for (const bool reversed : {false, true}) {
    const auto leaf = reversed ? LeafOfSwing(hinge, open, closed, 0.9) : LeafOfSwing(hinge, closed, open, 0.9);
    ASSERT_TRUE(leaf);
    EXPECT_EQ(leaf->operation, LeafOperation::kSwing);
    EXPECT_EQ(leaf->at_x, 1);
    EXPECT_EQ(leaf->opens_to_y, -1);
    EXPECT_NEAR(leaf->width_m, 0.9, 1e-12);
  }
}

TEST(LeafOfSwing, IsNoneForWhatClosesNoDoor) {
  EXPECT_FALSE(LeafOfSwing({0, 0}, {0.2, 0}, {0, 0.2}, 0.9)) << "a handle";
  EXPECT_FALSE(LeafOfSwing({0, 0}, {0.9, 0}, {0, 0.9}, 0.7)) << "wider than the door";
  EXPECT_FALSE(LeafOfSwing({0, 0}, {0.64, 0.64}, {-0.64, 0.64}, 0.9)) << "neither end in the door";
  EXPECT_FALSE(LeafOfSwing({0, 0}, {0.9, 0}, {0, 0.5}, 0.9)) << "no circle";
  EXPECT_TRUE(LeafOfSwing({0, 0}, {0.9, 0}, {0, 0.9}, 0)) << "of a door of unknown width";
}

FramedLeaf Swing(int at_x, int opens_to_y, double width_m) { return {LeafOperation::kSwing, at_x, opens_to_y, width_m}; }

TEST(OnePerJamb, SwingsToBothSidesAreDoubleActing) {
  const std::vector<FramedLeaf> leaves = OnePerJamb(std::vector{Swing(-1, 1, 0.9), Swing(-1, -1, 0.9)}, 0.9);
  ASSERT_EQ(leaves.size(), 1u);
  EXPECT_EQ(leaves[0].operation, LeafOperation::kDoubleActing);
  EXPECT_EQ(leaves[0].opens_to_y, 0);
}

TEST(OnePerJamb, KeepsUnequalLeavesFromLowToHigh) {
  const std::vector<FramedLeaf> leaves = OnePerJamb(std::vector{Swing(1, 1, 0.9), Swing(-1, -1, 0.4), Swing(1, 1, 0.85)}, 1.3);
  ASSERT_EQ(leaves.size(), 2u);
  EXPECT_EQ(leaves[0].at_x, -1);
  EXPECT_EQ(leaves[0].opens_to_y, -1);
  EXPECT_EQ(leaves[1].width_m, 0.9);
  EXPECT_TRUE(OnePerJamb(std::vector{Swing(1, 1, 0.9), Swing(-1, 1, 0.9)}, 0.9).empty()) << "they do not fit together";
}

}  // namespace
}  // namespace plumb::compiler
