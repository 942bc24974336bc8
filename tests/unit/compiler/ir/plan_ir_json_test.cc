#include "compiler/ir/plan_ir_json.h"

#include <gtest/gtest.h>

#include "tests/support/plan_builder.h"

namespace plumb::compiler {
namespace {

PlanIr FullPlan() {
  PlanIr plan = test::TwoRooms();
  plan.source_path = "a.ifc";
  plan.source_format = "IFC4";
  plan.source_sha256 = "00ff";
  plan.origin = {1e6, -2e6, 0.125};
  PlanElement& wall = plan.elements[0];
  wall.uncut = wall.body;
  wall.thickness_m = 0.3;
  wall.axis = {{0.1, 0.2}, {1.0 / 3, 4}};
  wall.arcs.push_back({{1, 2}, 3, 0.5, -1.25});
  wall.external = true;
  wall.material = Material::kGlass;
  wall.location = {12, 345, "guid", "IfcWall"};
  plan.spaces[0].long_name = "Küche";
  return plan;
}

TEST(PlanIrJson, ReadsBackWhatItWrote) {
  const PlanIr plan = FullPlan();
  const std::string text = PlanIrToJson(plan);
  const Expected<PlanIr> read = PlanIrFromJson(text);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(PlanIrToJson(*read), text);
  EXPECT_EQ(read->elements[0].axis->second.x(), 1.0 / 3);
  EXPECT_EQ(read->elements[0].arcs[0].sweep_rad, -1.25);
  EXPECT_EQ(read->elements[0].location.step_id, 345u);
  EXPECT_EQ(read->elements[0].uncut.triangles.size(), plan.elements[0].uncut.triangles.size());
  EXPECT_EQ(read->openings[0].filling, plan.openings[0].filling);
  EXPECT_EQ(read->origin, plan.origin);
  EXPECT_EQ(read->spaces[0].long_name, "Küche");
}

TEST(PlanIrJson, RefusesOtherText) {
  EXPECT_EQ(PlanIrFromJson("").error().code, ErrorCode::kFileUnreadable);
  EXPECT_EQ(PlanIrFromJson("{}").error().code, ErrorCode::kFileUnreadable);
  EXPECT_EQ(PlanIrFromJson("[1, 2").error().code, ErrorCode::kFileUnreadable);
  EXPECT_EQ(PlanIrFromJson(R"({"storeys":[{"elevation_m":"high"}],"elements":[],"openings":[],"spaces":[]})").error().code,
            ErrorCode::kFileUnreadable);
  EXPECT_EQ(PlanIrFromJson(R"({"storeys":[],"elements":[{"kind":99}],"openings":[],"spaces":[]})").error().code,
            ErrorCode::kFileUnreadable);
}

}  // namespace
}  // namespace plumb::compiler
