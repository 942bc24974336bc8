#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "compiler/ir/floor_ir.h"
#include "tests/support/plan_builder.h"

namespace plumb::compiler {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(VerifyPlanIr, AcceptsAGoodPlan) { EXPECT_THAT(VerifyPlanIr(test::TwoRooms()), IsEmpty()); }

TEST(VerifyPlanIr, NamesEachFault) {
  PlanIr plan = test::TwoRooms();
  plan.elements[1].storey = 7;
  EXPECT_THAT(VerifyPlanIr(plan), ElementsAre(HasSubstr("storey 7")));
  plan = test::TwoRooms();
  plan.elements[2].body.vertices[0].z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(VerifyPlanIr(plan), ElementsAre(HasSubstr("not finite")));
  plan = test::TwoRooms();
  plan.elements[2].body.triangles[0][1] = 1000;
  EXPECT_THAT(VerifyPlanIr(plan), ElementsAre(HasSubstr("no such vertex")));
  plan = test::TwoRooms();
  plan.openings[0].wall = 1000;
  EXPECT_THAT(VerifyPlanIr(plan), ElementsAre(HasSubstr("wall 1000")));
  plan = test::TwoRooms();
  plan.openings[0].width_m = -1.0;
  EXPECT_THAT(VerifyPlanIr(plan), ElementsAre(HasSubstr("width")));
  plan = test::TwoRooms();
  plan.storeys.push_back({"", "below", {}, -3});
  EXPECT_THAT(VerifyPlanIr(plan), ElementsAre(HasSubstr("sorted")));
}

TEST(VerifyFloorIr, NamesABoundaryThatDoesNotClose) {
  const PlanIr plan = test::TwoRooms();
  FloorIr ir;
  ir.walls.push_back({{0}, 0, 0, 1});
  Floor floor;
  floor.cut_heights_m = {1.1};
  floor.footprints.push_back({FootprintKind::kWall, 0, 0, true, {test::Rectangle({0, 0}, {1, 1})}});
  floor.vertices = test::Rectangle({0, 0}, {1, 1});
  FloorFace outside, inside;
  inside.cover = {0};
  for (uint32_t i = 0; i < 4; ++i) inside.outer.push_back({i, (i + 1) % 4, 0, {0}});
  outside.holes.push_back({{0, 3, 1, {0}}, {3, 2, 1, {0}}, {2, 1, 1, {0}}, {1, 0, 1, {0}}});
  floor.faces = {outside, inside};
  ir.floors.push_back(floor);
  EXPECT_THAT(VerifyFloorIr(ir, plan), IsEmpty());
  ir.floors[0].faces[1].outer.pop_back();
  EXPECT_THAT(VerifyFloorIr(ir, plan), ElementsAre(HasSubstr("not closed")));
}

}  // namespace
}  // namespace plumb::compiler
