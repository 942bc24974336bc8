// Plan in, recording in, pose and deviations out: the steps of tools/demo on a plan of our own and a short drive, through the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "runtime/sources/recording.h"
#include "schema/files.h"
#include "tests/support/program.h"
#include "tests/support/room_overlap.h"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class EndToEnd : public ::testing::Test {
 protected:
  // One run for all tests: it takes a minute.
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::ProgramFolder>("end_to_end");
    fs::create_directories(*folder_ / "truth");
    const std::string plan = std::string(PLUMB_SOURCE_DIR) + "/plans/site_office/plan.ifc";
    ASSERT_EQ(folder_->Plumb("compile '" + plan + "' -o plan.agraph"), 0);
    ASSERT_EQ(folder_->Plumb("simulate plan.agraph --seed 3 --deviate 1 --translation 0.15:0.25 --rotation 0:1 --sensor vlp16 "
                             "--duration 60 --max-duration 60 -o rec/"),
              0);
    // Out of the way: the localizer has to do without.
    fs::rename(*folder_ / "rec/truth.tum", *folder_ / "truth/truth.tum");
    fs::rename(*folder_ / "rec/truth.json", *folder_ / "truth/truth.json");
    ASSERT_EQ(folder_->Plumb("localize plan.agraph rec/ -o run/"), 0);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::unique_ptr<test::ProgramFolder> folder_;
};

std::unique_ptr<test::ProgramFolder> EndToEnd::folder_;

TEST_F(EndToEnd, WritesEveryFileOfARun) {
  for (const char* name : {"trajectory.tum", "trajectory_smoothed.tum", "verdicts.csv", "timing.csv", "map.ply", "sgraph.json",
                           "deviations.json", "run.json"}) {
    EXPECT_TRUE(fs::exists(*folder_ / "run" / name)) << name;
  }
  const auto smoothed = runtime::ReadTum((*folder_ / "run/trajectory_smoothed.tum").string());
  const auto online = runtime::ReadTum((*folder_ / "run/trajectory.tum").string());
  const auto recording = runtime::Recording::Open((*folder_ / "rec").string());
  ASSERT_TRUE(smoothed && online && recording);
  EXPECT_EQ(smoothed->size(), recording->size());
  EXPECT_LE(online->size(), smoothed->size());
  EXPECT_EQ(folder_->Json("run/deviations.json").at("version"), 1);
  EXPECT_EQ(folder_->Json("run/run.json").at("summary").at("scans"), recording->size());
}

TEST_F(EndToEnd, LocalizesAndFindsTheDeviation) {
  EXPECT_EQ(folder_->Plumb("evaluate run/ --truth truth/ --json run/evaluation.json --require-localized-within 30 --require-ate 0.06"), 0);
  const Json evaluation = folder_->Json("run/evaluation.json");
  EXPECT_EQ(evaluation.at("walls_false"), 0);
  EXPECT_EQ(evaluation.at("walls_missed"), 0);
  EXPECT_EQ(evaluation.at("walls_found"), 1);
  EXPECT_LT(evaluation.at("max_error_translation_m").get<double>(), 0.03);
}

TEST_F(EndToEnd, FindsTheRoomsThatItDroveThrough) {
  EXPECT_EQ(folder_->Plumb("inspect plan.agraph --json > plan.json"), 0);
  const Json plan = folder_->Json("plan.json"), sgraph = folder_->Json("run/sgraph.json");
  EXPECT_EQ(sgraph.at("frame"), "plan");
  EXPECT_EQ(sgraph.at("floors").size(), 1u);
  int visited = 0;
  for (const Json& room : sgraph.at("rooms")) {
    if (!room.at("visited").get<bool>()) continue;
    ++visited;
    EXPECT_GT(test::BestOverlap(test::RingOf(room.at("polygon")), plan.at("rooms")), 0.8) << room.at("id");
  }
  EXPECT_GE(visited, 1);
  EXPECT_GE(sgraph.at("doorways").size(), 4u);
  for (const Json& doorway : sgraph.at("doorways")) {
    const auto near = [&](const Json& planned) {
      return (test::PointOf(planned.at("position")) - test::PointOf(doorway.at("position"))).norm() < 0.1;
    };
    EXPECT_TRUE(std::any_of(plan.at("doorways").begin(), plan.at("doorways").end(), near)) << doorway;
  }
}

TEST_F(EndToEnd, ReportsAndChecks) {
  EXPECT_EQ(folder_->Plumb("report run/ -o run/report.html"), 0);
  EXPECT_GT(fs::file_size(*folder_ / "run/report.html"), 10000u);
  EXPECT_EQ(folder_->Plumb("validate plan.agraph"), 0);
  EXPECT_EQ(folder_->Plumb("doctor rec/ > doctor.txt"), 0);
}

TEST_F(EndToEnd, FindsAPlanarLaserInFurnishedOffices) {
  const std::string recording = PLUMB_SOURCE_DIR "/../shared/data/lidar/fr079";
  if (!fs::exists(recording + "/truth.tum")) GTEST_SKIP() << "the recording fr079 is not there";
  ASSERT_EQ(folder_->Plumb("compile '" + recording + "/asbuilt.dxf' -q -o offices.agraph"), 0);
  EXPECT_EQ(folder_->Plumb("localize offices.agraph '" + recording + "' --start 53 --max-duration 40 -q -o planar/"), 0);
  EXPECT_EQ(
      folder_->Plumb("evaluate planar/ --truth '" + recording + "' --json planar.json --require-localized-within 20 --require-ate 0.10"),
      0);
  EXPECT_TRUE(folder_->Json("planar.json").at("in_plane").get<bool>());
  for (const auto& surface : folder_->Json("planar/deviations.json").at("surfaces")) EXPECT_EQ(surface.at("status"), "unobserved");
}

// The walls of a corridor, half of them hidden, would lay the plan 40 cm aside.
TEST_F(EndToEnd, KeepsAPlanarLaserWhereItWasFound) {
  const std::string recording = PLUMB_SOURCE_DIR "/../shared/data/lidar/fr079";
  if (!fs::exists(recording + "/truth.tum")) GTEST_SKIP() << "the recording fr079 is not there";
  ASSERT_EQ(folder_->Plumb("compile '" + recording + "/asbuilt.dxf' -q -o corridor.agraph"), 0);
  EXPECT_EQ(folder_->Plumb("localize corridor.agraph '" + recording + "' --start 104.676 --max-duration 60 -q -o corridor/"), 0);
  EXPECT_EQ(folder_->Plumb("evaluate corridor/ --truth '" + recording +
                           "' --json corridor.json --require-localized-within 30 --require-ate 0.15"),
            0);
  EXPECT_EQ(folder_->Json("corridor.json").at("wrong_fixes"), 0);
}

TEST_F(EndToEnd, RefusesBadInputWithStatusTwo) {
  EXPECT_EQ(folder_->Plumb("localize rec/odometry.tum rec/ -o other/ 2> error.txt"), 2);
  EXPECT_EQ(folder_->Plumb("localize plan.agraph truth/ -o other/ 2> error.txt"), 2);
  EXPECT_EQ(folder_->Plumb("localize plan.agraph rec/ -o other/ --matcher rooms 2> error.txt"), 2);
  EXPECT_THAT(*ReadFileText((*folder_ / "error.txt").string()), ::testing::HasSubstr("{wall,graph}"));
  EXPECT_EQ(folder_->Plumb("evaluate truth/ --truth truth/ 2> error.txt"), 2);
  EXPECT_EQ(folder_->Plumb("simulate plan.agraph --translation far -o other/ 2> error.txt"), 2);
}

}  // namespace
}  // namespace plumb
