// From a simulated tour to the score: a real house without one of its walls and with one that is in no plan, and an office floor whose
// doorways are elsewhere or of another width.
#include "tests/support/program.h"

namespace plumb {
namespace {

TEST(WallChanges, TheMissingWallOfTheFzkHouseIsFoundAndNothingIsMadeUp) {
  const std::string source = test::SharedPlan("ifc/AC20-FZK-Haus.ifc");
  if (!std::filesystem::exists(source)) GTEST_SKIP() << source << " is not there";
  const test::ProgramFolder folder("wall_changes");
  ASSERT_EQ(folder.Plumb("compile '" + source + "' -o plan.agraph 2> compile.txt"), 0);
  ASSERT_EQ(folder.Plumb(
                "simulate plan.agraph --seed 5 --deviate 0 --missing 1 --unplanned 1 --clutter 6 --duration 90 --max-duration 90 -o rec/"),
            0);
  ASSERT_EQ(folder.Plumb("localize plan.agraph rec/ -o run/"), 0);
  ASSERT_EQ(folder.Plumb("evaluate run/ --truth rec/ --json run/evaluation.json"), 0);
  const auto evaluation = folder.Json("run/evaluation.json");
  EXPECT_EQ(evaluation.at("missing_found"), 1);
  EXPECT_EQ(evaluation.at("missing_false"), 0);
  EXPECT_EQ(evaluation.at("unplanned_false"), 0);
  EXPECT_EQ(evaluation.at("walls_false"), 0);
  EXPECT_EQ(folder.Json("run/run.json").at("summary").at("missing_walls"), 1);
}

TEST(WallChanges, DoorwaysThatAreElsewhereOrNarrowerAreFound) {
  const test::ProgramFolder folder("doorway_changes");
  ASSERT_EQ(folder.Plumb("compile '" PLUMB_SOURCE_DIR "/plans/office_floor/plan.dxf' -o plan.agraph 2> compile.txt"), 0);
  ASSERT_EQ(folder.Plumb("simulate plan.agraph --seed 11 --deviate 0 --doorways 70% --doorway-shift 0.05:0.3 --speed 0.8 --duration 45 "
                         "--max-duration 45 -o rec/"),
            0);
  ASSERT_EQ(folder.Plumb("localize plan.agraph rec/ -o run/"), 0);
  ASSERT_EQ(folder.Plumb("evaluate run/ --truth rec/ --json run/evaluation.json"), 0);
  const auto evaluation = folder.Json("run/evaluation.json");
  EXPECT_GE(evaluation.at("doorways_found"), 2);
  EXPECT_EQ(evaluation.at("doorways_false"), 0);
  EXPECT_EQ(evaluation.at("doorways_missed"), 0);
  EXPECT_LT(evaluation.at("doorways_mean_error_m"), 0.01);
}

}  // namespace
}  // namespace plumb
