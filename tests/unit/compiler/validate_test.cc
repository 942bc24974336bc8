#include "compiler/validate.h"

#include <gtest/gtest.h>

#include "tests/support/house.h"

namespace plumb::compiler {
namespace {

TEST(ReportOf, AnswersWithTheOutcome) {
  CompileResult result;
  EXPECT_EQ(ReportOf("p", result).outcome, Outcome::kBadInput);
  result.graph = test::MakeHouse();
  EXPECT_EQ(ReportOf("p", result, true).outcome, Outcome::kFine);
  EXPECT_EQ(ReportOf("p", result).answer, "a robot can localize in this (3 rooms, 16 wall surfaces, 1 storey)");
  CompileResult walls;
  walls.graph = test::MakeHouse();
  walls.graph->rooms.clear();
  EXPECT_EQ(ReportOf("p", walls).answer, "a robot can localize in this by its walls alone (0 rooms, 16 wall surfaces, 1 storey)");
  result.diagnostics.Emit(DiagnosticKind::kRoomWithoutDoorway, {}, "w");
  EXPECT_EQ(ReportOf("p", result).outcome, Outcome::kFine);
  EXPECT_EQ(ReportOf("p", result, true).outcome, Outcome::kFindings);
  result.diagnostics.Emit(DiagnosticKind::kRoomsOverlap, {}, "e");
  EXPECT_EQ(ReportOf("p", result).outcome, Outcome::kFindings);
  result.diagnostics.Emit(DiagnosticKind::kInternalError, {}, "i");
  EXPECT_EQ(ReportOf("p", result).outcome, Outcome::kInternal);
}

TEST(ReportOf, SaysWhereNoPoseIsTheOnlyOne) {
  CompileResult result;
  result.graph = test::MakeHouse();
  Alias alias;
  alias.rooms = {RoomId(0)};
  alias.twins = {RoomId(1)};
  result.graph->aliases = {alias};
  EXPECT_EQ(ReportOf("p", result, false, true).outcome, Outcome::kFine) << "a doorway leads on from there";
  result.graph->aliases[0].closed = true;
  EXPECT_EQ(ReportOf("p", result, false, true).outcome, Outcome::kFine);
  EXPECT_NE(ReportOf("p", result, false, true).answer.find(", but within 2 rooms the plan looks the same from another place"), std::string::npos)
      << ReportOf("p", result, false, true).answer;
  result.graph->aliases[0].rooms.push_back(RoomId(2));
  result.graph->aliases[0].twins.push_back(RoomId(2));
  EXPECT_EQ(ReportOf("p", result, false, true).outcome, Outcome::kFindings);
  EXPECT_EQ(ReportOf("p", result).outcome, Outcome::kFine) << "as a compilation";
  EXPECT_NE(ReportOf("p", result, false, true).answer.find("no robot can tell where it is"), std::string::npos)
      << ReportOf("p", result, false, true).answer;
}

TEST(Compile, RefusesInvalidOptions) {
  CompileOptions options;
  options.snap_radius_m = 0;
  const CompileResult result = Compile("/nonexistent.ifc", options);
  EXPECT_FALSE(result.graph);
  EXPECT_TRUE(result.has_internal_error());
  EXPECT_FALSE(Compile("/nonexistent.ifc").has_internal_error());
}

}  // namespace
}  // namespace plumb::compiler
