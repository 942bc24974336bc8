#include "tools/drawing/door_symbol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "schema/files.h"
#include "tests/support/house.h"
#include "tools/drawing/floor_plan.h"

namespace plumb::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kGolden[] = PLUMB_SOURCE_DIR "/tests/unit/tools/drawing/golden/doors.svg";

// D1 of the house joins A (below) and B (above) through a wall 0.12 m thick from y = 3.36 to 3.48; its middle is (2.5, 3.42) and yaw leads
// up.
class DoorSymbolTest : public testing::Test {
 protected:
  DoorSymbolTest() {
    door().has_leaf = true;
    middle_ = door().position.head<2>();
    thickness_m_ = house_.walls[door().wall.index()].thickness_m;
  }

  Doorway& door() { return house_.doorways[0]; }
  std::string Draw(const std::vector<DoorLeaf>& leaves) {
    door().leaves = leaves;
    return DrawDoor(house_, door(), sheet_);
  }
  // `left_m` to the left of who passes, `on_m` ahead of the wall's middle.
  Eigen::Vector2d At(double left_m, double on_m) {
    const double yaw_rad = door().yaw_rad;
    return middle_ + left_m * Eigen::Vector2d(-std::sin(yaw_rad), std::cos(yaw_rad)) +
           on_m * Eigen::Vector2d(std::cos(yaw_rad), std::sin(yaw_rad));
  }
  std::string Leaf(const Eigen::Vector2d& from, const Eigen::Vector2d& to) { return "class=\"leaf\" d=\"" + sheet_.Line(from, to) + "\""; }
  static size_t Count(const std::string& text, const std::string& part) {
    size_t n = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
  }

  AGraph house_ = test::MakeHouse();
  const Sheet sheet_ = SheetOf(house_, StoreyId(0));
  Eigen::Vector2d middle_;
  double thickness_m_ = 0;
};

TEST_F(DoorSymbolTest, HingeAndSideAreThoseOfThePlan) {
  const double half = 0.5 * door().width_m, face = 0.5 * thickness_m_, w = door().width_m;
  for (const Jamb jamb : {Jamb::kLeft, Jamb::kRight}) {
    for (const DoorwaySide side : {DoorwaySide::kRoomA, DoorwaySide::kRoomB}) {
      const double s = jamb == Jamb::kLeft ? half : -half, t = side == DoorwaySide::kRoomB ? 1 : -1;
      const std::string svg = Draw({{LeafOperation::kSwing, jamb, side}});
      EXPECT_THAT(svg, HasSubstr(Leaf(At(s, t * face), At(s, t * (face + w)))));
      // From the tip around the hinge to the other jamb, the short way: clockwise on the sheet where the leaf swings to its right.
      const std::string r = Decimal(sheet_.Length(w)), sweep = (s > 0) == (t > 0) ? "1" : "0";
      EXPECT_THAT(svg, HasSubstr("class=\"swing\" d=\"M" + sheet_.At(At(s, t * (face + w))) + "A" + r + " " + r + " 0 0 " + sweep + " " +
                                 sheet_.At(At(-s, t * face))));
      EXPECT_EQ(Count(svg, "class=\"leaf\""), 1u);
    }
  }
}

// The same door told from the other room is the same drawing.
TEST_F(DoorSymbolTest, TheOrderOfTheRoomsDoesNotMatter) {
  const std::string svg = Draw({{LeafOperation::kSwing, Jamb::kLeft, DoorwaySide::kRoomB}});
  std::swap(door().room_a, door().room_b);
  door().yaw_rad += std::numbers::pi;
  const std::string turned = Draw({{LeafOperation::kSwing, Jamb::kRight, DoorwaySide::kRoomA}});
  EXPECT_EQ(turned.substr(turned.find("class=\"leaf\""), 60), svg.substr(svg.find("class=\"leaf\""), 60));
}

TEST_F(DoorSymbolTest, WhatIsUnknownIsDrawnAsIsCommon) {
  const std::string common = Draw({});
  EXPECT_EQ(Draw({{}}), common);
  EXPECT_EQ(Draw({{LeafOperation::kSwing}}), common);
  EXPECT_EQ(Count(Draw({{}, {}}), "class=\"leaf\""), 2u);  // narrow, but the plan says two
}

TEST_F(DoorSymbolTest, WhatIsUnknownIsDrawnApart) {
  EXPECT_EQ(Count(Draw({}), "class=\"assumed\""), 1u);
  EXPECT_EQ(Count(Draw({{LeafOperation::kSwing, Jamb::kLeft}}), "class=\"assumed\""), 1u);
  EXPECT_EQ(Count(Draw({{LeafOperation::kSwing, Jamb::kLeft, DoorwaySide::kRoomB}}), "class=\"assumed\""), 0u);
  EXPECT_EQ(Count(Draw({{LeafOperation::kSliding, Jamb::kLeft}}), "class=\"assumed\""), 0u);
}

TEST_F(DoorSymbolTest, UnequalLeavesFillTheDoorInTheirRatio) {
  const double w = door().width_m, face = 0.5 * thickness_m_;
  const std::string svg = Draw(
      {{LeafOperation::kSwing, Jamb::kLeft, DoorwaySide::kRoomB, 0.3}, {LeafOperation::kSwing, Jamb::kRight, DoorwaySide::kRoomA, 0.9}});
  EXPECT_THAT(svg, HasSubstr(Leaf(At(0.5 * w, face), At(0.5 * w, face + 0.25 * w))));
  EXPECT_THAT(svg, HasSubstr(Leaf(At(-0.5 * w, -face), At(-0.5 * w, -face - 0.75 * w))));
}

TEST_F(DoorSymbolTest, EachOperationHasItsSymbol) {
  EXPECT_EQ(Count(Draw({{LeafOperation::kDoubleActing, Jamb::kLeft}}), "class=\"swing\""), 2u);
  const double half = 0.5 * door().width_m;
  EXPECT_THAT(Draw({{LeafOperation::kFixed, Jamb::kLeft}}), HasSubstr(Leaf(At(half, 0), At(-half, 0))));
  const std::string slides = Draw({{LeafOperation::kSliding, Jamb::kRight}});
  EXPECT_THAT(slides, HasSubstr(Leaf(At(-half, 0), At(half, 0))));
  EXPECT_THAT(slides, Not(HasSubstr("A")));
  EXPECT_EQ(Count(Draw({{LeafOperation::kSliding}, {LeafOperation::kSliding}}), "class=\"leaf\""), 2u);
  EXPECT_EQ(Count(Draw({{LeafOperation::kRevolving}}), "A"), 2u);  // two half circles
  EXPECT_THAT(Draw({{LeafOperation::kLifting}}), HasSubstr("class=\"lintel\""));
  EXPECT_EQ(Count(Draw({{LeafOperation::kFolding, Jamb::kLeft, DoorwaySide::kRoomA}}), "class=\"leaf\""), 1u);
}

TEST_F(DoorSymbolTest, ACutOverTheLintelShowsNoLeaf) {
  door().leaves = {{LeafOperation::kSwing, Jamb::kLeft, DoorwaySide::kRoomB}};
  const auto leaves = [&](double height_m) {
    FloorPlanOptions options;
    options.section_height_m = height_m;
    return Count(DrawFloorPlan(house_, StoreyId(0), sheet_, options), "class=\"leaf\"");
  };
  EXPECT_EQ(leaves(1.1), 2u);  // D1 and D3
  EXPECT_EQ(leaves(2.4), 0u);
  for (Doorway& d : house_.doorways) d.position.z() -= 1.5;  // in a room that is sunk its lintel is below the cut
  EXPECT_EQ(leaves(1.1), 0u);
}

TEST_F(DoorSymbolTest, OfTwoLeavesTheOneWithoutAJambHangsAtTheOther) {
  const double w = door().width_m, face = 0.5 * thickness_m_;
  for (const Jamb known : {Jamb::kLeft, Jamb::kRight}) {
    for (const bool first : {true, false}) {
      std::vector<DoorLeaf> leaves = {{LeafOperation::kSwing, known, DoorwaySide::kRoomB},
                                      {LeafOperation::kSwing, Jamb::kUnknown, DoorwaySide::kRoomB}};
      if (!first) std::swap(leaves[0], leaves[1]);
      const std::string svg = Draw(leaves);
      for (const double side : {-0.5, 0.5}) EXPECT_THAT(svg, HasSubstr(Leaf(At(side * w, face), At(side * w, face + 0.5 * w))));
    }
  }
}

TEST_F(DoorSymbolTest, WhatIsUnknownDoesNotOpenIntoAClosetThatIsTooShallow) {
  const double w = door().width_m, face = 0.5 * thickness_m_;
  for (Eigen::Vector2d& p : house_.rooms[door().room_b.index()].polygon) p.y() = std::min(p.y(), middle_.y() + 0.6 * w);
  const std::string to_a = Draw({});
  EXPECT_TRUE(to_a.find(Leaf(At(0.5 * w, -face), At(0.5 * w, -face - w))) != std::string::npos ||
              to_a.find(Leaf(At(-0.5 * w, -face), At(-0.5 * w, -face - w))) != std::string::npos)
      << to_a;
}

TEST_F(DoorSymbolTest, ADoorTooWideForTwoLeavesIsDrawnShut) {
  door().width_m = 3;
  EXPECT_THAT(Draw({}), HasSubstr("class=\"assumed\""));
  EXPECT_THAT(Draw({}), Not(HasSubstr("class=\"swing\"")));
}

// All kinds side by side, for people to look at. PLUMB_UPDATE_GOLDEN=1 rewrites it.
TEST_F(DoorSymbolTest, MatchesTheGoldenFile) {
  using Op = LeafOperation;
  const auto leaf = [](Op op, Jamb jamb = Jamb::kUnknown, DoorwaySide side = DoorwaySide::kUnknown, double width_m = 0) {
    return DoorLeaf{op, jamb, side, width_m};
  };
  constexpr auto kL = Jamb::kLeft, kR = Jamb::kRight;
  constexpr auto kA = DoorwaySide::kRoomA, kB = DoorwaySide::kRoomB;
  const std::vector<std::vector<DoorLeaf>> all = {{leaf(Op::kSwing, kL, kB)},
                                                  {leaf(Op::kSwing, kR, kA)},
                                                  {leaf(Op::kSwing, kL, kB, 1.2), leaf(Op::kSwing, kR, kB, 0.6)},
                                                  {leaf(Op::kSwing, kL, kB), leaf(Op::kSwing, kR, kA)},
                                                  {leaf(Op::kDoubleActing, kL), leaf(Op::kDoubleActing, kR)},
                                                  {leaf(Op::kSliding, kL)},
                                                  {leaf(Op::kSliding, kL), leaf(Op::kSliding, kR)},
                                                  {leaf(Op::kSliding), leaf(Op::kSliding)},
                                                  {leaf(Op::kFolding, kL, kB), leaf(Op::kFolding, kR, kB)},
                                                  {leaf(Op::kRevolving)},
                                                  {leaf(Op::kLifting, Jamb::kUnknown, kB)},
                                                  {leaf(Op::kSwing, kL, kB), leaf(Op::kFixed, kR)}};
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1400 950\">\n<style>\n.opening{fill:#ddd}\n.leaf{stroke:#000;stroke-width:4;"
      "fill:none}\n.swing,.sill{stroke:#888;fill:none}\n.lintel{stroke:#888;stroke-dasharray:8 5;fill:none}\n</style>\n";
  const Sheet sheet({0, 0}, {14, 9.5}, 0);
  AGraph g;
  for (size_t i = 0; i < all.size(); ++i) {
    Doorway d;
    d.position = {2 + 3.3 * static_cast<double>(i % 4), 7.5 - 3 * static_cast<double>(i / 4), 0};
    d.yaw_rad = std::numbers::pi / 2;
    d.width_m = 1.8;
    d.leaves = all[i];
    svg += DrawDoor(g, d, sheet);
  }
  svg += "</svg>\n";
  if (std::getenv("PLUMB_UPDATE_GOLDEN") != nullptr) {
    ASSERT_TRUE(WriteFileAtomically(kGolden, std::string_view(svg)));
  }
  EXPECT_EQ(ReadFileText(kGolden).value_or(""), svg);
}

}  // namespace
}  // namespace plumb::tools
