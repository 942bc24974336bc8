// A real house without one of its walls and with one that is in no plan, from a simulated tour to the score.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.h"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::Plumb;
using test::ReadJson;

TEST(WallChanges, TheMissingWallOfTheFzkHouseIsFoundAndNothingIsMadeUp) {
  const std::string source = PLUMB_SOURCE_DIR "/../shared/data/plans/ifc/AC20-FZK-Haus.ifc";
  if (!fs::exists(source)) GTEST_SKIP() << "the plan AC20-FZK-Haus.ifc is not there";
  const fs::path folder = fs::path(::testing::TempDir()) / ("plumb_wall_changes." + std::to_string(getpid()));
  fs::create_directories(folder);
  ASSERT_EQ(Plumb(folder, "compile '" + source + "' -o plan.agraph 2> compile.txt"), 0);
  ASSERT_EQ(Plumb(folder, "simulate plan.agraph --seed 5 --deviate 0 --missing 1 --unplanned 1 --clutter 6 --duration 90 --max-duration 90 -o rec/"), 0);
  ASSERT_EQ(Plumb(folder, "localize plan.agraph rec/ -o run/"), 0);
  ASSERT_EQ(Plumb(folder, "evaluate run/ --truth rec/ --json run/evaluation.json"), 0);
  const Json evaluation = ReadJson(folder / "run/evaluation.json");
  EXPECT_EQ(evaluation.at("missing_found"), 1);
  EXPECT_EQ(evaluation.at("missing_false"), 0);
  EXPECT_EQ(evaluation.at("unplanned_false"), 0);
  EXPECT_EQ(evaluation.at("walls_false"), 0);
  const Json summary = ReadJson(folder / "run/run.json").at("summary");
  EXPECT_EQ(summary.at("missing_walls"), 1);
  if (!::testing::Test::HasFailure()) fs::remove_all(folder);
}

}  // namespace
}  // namespace plumb
