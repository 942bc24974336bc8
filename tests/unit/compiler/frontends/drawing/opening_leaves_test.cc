#include "compiler/frontends/drawing/opening_leaves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr double kQuarter_rad = std::numbers::pi / 2;

// A door 1 m wide from (0, 0) to (1, 0) in a wall 0.2 m thick, turned and moved.
class Doors {
 public:
  explicit Doors(double yaw_rad = 0) : rotation_(yaw_rad) {
    door_.use = DrawnUse::kDoor;
    door_.from = At({0, 0});
    door_.to = At({1, 0});
    door_.depth_m = 0.2;
  }

  Doors& Swing(const Vector2d& hinge, double radius_m, double from_rad, double sweep_rad) {
    DrawnPath path;
    path.curved = true;
    path.arcs.push_back({At(hinge), radius_m, from_rad + rotation_.angle(), sweep_rad});
    return Add(path);
  }

  Doors& Line(const Vector2d& a, const Vector2d& b) {
    DrawnPath path;
    path.points = {At(a), At(b)};
    return Add(path);
  }

  Doors& Box(const Vector2d& lo, const Vector2d& hi) {
    DrawnPath path;
    path.points = {At(lo), At({hi.x(), lo.y()}), At(hi), At({lo.x(), hi.y()})};
    path.closed = true;
    return Add(path);
  }

  DrawnOpening& door() { return door_; }
  // In the frame before it was turned.
  [[nodiscard]] std::vector<PlanLeaf> Leaves() const {
    std::vector<uint32_t> all;
    for (uint32_t p = 0; p < drawing_.paths.size(); ++p) all.push_back(p);
    const OpeningOptions options;
    std::vector<PlanLeaf> out = OpeningLeaves(drawing_, all, options).Of(door_);
    for (PlanLeaf& leaf : out) {
      leaf.to_jamb = rotation_.inverse() * leaf.to_jamb;
      leaf.opens_to = rotation_.inverse() * leaf.opens_to;
    }
    return out;
  }

 private:
  [[nodiscard]] Vector2d At(const Vector2d& p) const { return rotation_ * p + Vector2d(30, -4); }
  Doors& Add(DrawnPath& path) {
    path.role = LineRole::kDoor;
    drawing_.paths.push_back(path);
    return *this;
  }

  Eigen::Rotation2Dd rotation_;
  Drawing drawing_;
  DrawnOpening door_;
};

void ExpectLeaf(const PlanLeaf& leaf, LeafOperation operation, const Vector2d& to_jamb, const Vector2d& opens_to, double width_m) {
  EXPECT_EQ(leaf.operation, operation);
  EXPECT_LT((leaf.to_jamb - to_jamb).norm(), 1e-9) << leaf.to_jamb.transpose();
  EXPECT_LT((leaf.opens_to - opens_to).norm(), 1e-9) << leaf.opens_to.transpose();
  EXPECT_NEAR(leaf.width_m, width_m, 1e-9);
}

TEST(OpeningLeaves, ASwingTellsHingeAndSideHoweverTheDoorIsTurned) {
  for (const double yaw_rad : {0.0, 0.7, 2.0, -2.5}) {
    Doors doors(yaw_rad);
    doors.Swing({1, -0.1}, 1.0, std::numbers::pi, kQuarter_rad);
    for (const bool reversed : {false, true}) {
      if (reversed) std::swap(doors.door().from, doors.door().to);
      const auto leaves = doors.Leaves();
      ASSERT_EQ(leaves.size(), 1u);
      ExpectLeaf(leaves[0], LeafOperation::kSwing, {1, 0}, {0, -1}, 1.0);
    }
  }
}

TEST(OpeningLeaves, UnequalLeavesThatOpenOppositeWays) {
  const auto leaves = Doors().Swing({0, 0.1}, 0.5, 0, kQuarter_rad).Swing({1, -0.1}, 0.5, std::numbers::pi, kQuarter_rad).Leaves();
  ASSERT_EQ(leaves.size(), 2u);
  ExpectLeaf(leaves[0], LeafOperation::kSwing, {-1, 0}, {0, 1}, 0.5);
  ExpectLeaf(leaves[1], LeafOperation::kSwing, {1, 0}, {0, -1}, 0.5);
}

TEST(OpeningLeaves, ArcsToBothSidesAreDoubleActing) {
  const auto leaves = Doors().Swing({0, 0}, 0.95, 0, kQuarter_rad).Swing({0, 0}, 0.95, 0, -kQuarter_rad).Leaves();
  ASSERT_EQ(leaves.size(), 1u);
  ExpectLeaf(leaves[0], LeafOperation::kDoubleActing, {-1, 0}, {0, 0}, 0.95);
}

TEST(OpeningLeaves, ASwingOfTheDoorNextToItIsNotItsOwn) {
  // Hinge on the jamb between the two.
  EXPECT_TRUE(Doors().Swing({1.05, 0}, 0.9, 0, kQuarter_rad).Leaves().empty());
}

TEST(OpeningLeaves, ALeafThatStandsOpenNeedsNoSwing) {
  const auto leaves = Doors().Box({0, 0.1}, {0.04, 1.08}).Leaves();
  ASSERT_EQ(leaves.size(), 1u);
  ExpectLeaf(leaves[0], LeafOperation::kSwing, {-1, 0}, {0, 1}, 0.98);
  EXPECT_TRUE(Doors().Line({0, -0.1}, {0, 0.1}).Line({1, -0.1}, {1, 0.1}).Leaves().empty()) << "the ends of the wall";
  EXPECT_TRUE(Doors().Line({0, 0}, {1, 0}).Leaves().empty()) << "a closed leaf";
}

TEST(OpeningLeaves, PanelsBehindEachOtherSlide) {
  const auto leaves = Doors().Box({0, 0.01}, {0.53, 0.05}).Box({0.47, -0.05}, {1, -0.01}).Leaves();
  ASSERT_EQ(leaves.size(), 2u);
  for (const PlanLeaf& leaf : leaves) ExpectLeaf(leaf, LeafOperation::kSliding, {0, 0}, {0, 0}, 0);
  EXPECT_TRUE(Doors().Box({0, -0.02}, {0.5, 0.02}).Box({0.5, -0.02}, {1, 0.02}).Leaves().empty()) << "two leaves that meet";
}

TEST(OpeningLeaves, PassagesHaveNone) {
  Doors doors;
  doors.Swing({1, 0}, 1.0, std::numbers::pi, kQuarter_rad).door().use = DrawnUse::kPassage;
  EXPECT_TRUE(doors.Leaves().empty());
}

}  // namespace
}  // namespace plumb::compiler
