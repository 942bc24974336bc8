#include "compiler/passes/assign_storeys.h"

#include <gtest/gtest.h>

#include "tests/support/plan_builder.h"
#include "tests/unit/compiler/passes/build.h"

namespace plumb::compiler {
namespace {

PlanIr ThreeStoreys() {
  test::PlanBuilder b;
  b.Storey("Ground", 0);
  b.Storey("Landing", 1.2);
  b.Storey("First", 3);
  b.On(kNoIndex).Wall("loose", {0, 0}, {1, 0}, 0.2, 2.9, 5.5);
  b.On(0).Wall("right", {0, 0}, {1, 0}, 0.2, -0.3, 2.5);
  b.On(2).Wall("wrong", {0, 0}, {1, 0}, 0.2, 0, 1.9);
  return b.plan;
}

TEST(AssignStoreys, UsesGeometryWhereTheSourceIsSilentOrWrong) {
  PlanIr plan = ThreeStoreys();
  DiagnosticSink sink;
  AssignStoreys(plan, {}, sink);
  EXPECT_EQ(plan.elements[0].storey, 2u);
  EXPECT_EQ(plan.elements[1].storey, 0u);
  EXPECT_EQ(plan.elements[2].storey, 0u);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kStoreyFromGeometry), 1u);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kElementInWrongStorey), 1u);
}

TEST(AssignStoreys, MakesAStoreyAtTheLowestWall) {
  PlanIr plan = ThreeStoreys();
  plan.storeys.clear();
  for (PlanElement& e : plan.elements) e.storey = kNoIndex;
  DiagnosticSink sink;
  AssignStoreys(plan, {}, sink);
  ASSERT_EQ(plan.storeys.size(), 1u);
  EXPECT_DOUBLE_EQ(plan.storeys[0].elevation_m, -0.3);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kStoreyMissing), 1u);
  EXPECT_EQ(CountOf(sink, DiagnosticKind::kStoreyFromGeometry), 0u);
}

TEST(GroupStoreys, ALandingSharesTheLevelBelowIt) {
  const std::vector<Level> levels = GroupStoreys(ThreeStoreys(), 1.1, {});
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_EQ(levels[0].last_storey, 1u);
  EXPECT_DOUBLE_EQ(levels[0].section_z_m, 2.3);
  EXPECT_DOUBLE_EQ(levels[0].top_z_m, 3.0);
  EXPECT_DOUBLE_EQ(levels[1].top_z_m, 5.5);
  EXPECT_EQ(LevelAt(levels, 2.8, 0.5), 1u);
  EXPECT_EQ(LevelAt(levels, 1.0, 0.5), 0u);
  EXPECT_EQ(LevelAt(levels, -7, 0.5), 0u);
}

}  // namespace
}  // namespace plumb::compiler
