#include "tools/evaluate/evaluate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace plumb::tools {
namespace {

using ::testing::HasSubstr;

runtime::StampedPose At(double stamp_s, double x) {
  runtime::StampedPose pose;
  pose.stamp_s = stamp_s;
  pose.T.translation().x() = x;
  return pose;
}

// Ten scans at 10 Hz from 100 s on, robot at rest at x = 0; localized from the fourth on, but for the eighth.
Run MakeRun() {
  tools::Run run;
  for (int i = 0; i < 10; ++i) {
    const double stamp_s = 100 + 0.1 * i;
    const bool localized = i >= 3 && i != 7;
    run.verdicts.push_back({stamp_s, localized ? "localized" : i < 3 ? "searching" : "lost", localized ? 1 : 0});
    if (i >= 3) run.online.push_back(At(stamp_s, 0.03));
    run.smoothed.push_back(At(stamp_s, 0.01));
  }
  return run;
}

Truth MakeTruth() {
  Truth truth;
  for (int i = 0; i <= 10; ++i) truth.trajectory.push_back(At(100 + 0.1 * i, 0));
  return truth;
}

TEST(Evaluate, LeavesHeightsOutInThePlane) {
  tools::Run run = MakeRun();
  for (runtime::StampedPose& pose : run.online) pose.T.translation().z() = 1.5;
  EXPECT_GT(Evaluate(run, MakeTruth()).wrong_fixes, 0u);
  EvaluateOptions options;
  options.in_plane = true;
  const Evaluation e = Evaluate(run, MakeTruth(), options);
  EXPECT_EQ(e.wrong_fixes, 0u);
  EXPECT_NEAR(e.online.rmse_m, 0.03, 1e-12);
  EXPECT_THAT(EvaluationToText(e), HasSubstr("in x and y"));
}

TEST(Evaluate, MeasuresTimeAndShareFromTheVerdicts) {
  const Evaluation e = Evaluate(MakeRun(), MakeTruth());
  ASSERT_TRUE(e.time_to_localize_s);
  EXPECT_NEAR(*e.time_to_localize_s, 0.3, 1e-9);
  EXPECT_EQ(e.scans, 10u);
  EXPECT_EQ(e.localized_scans, 6u);
  EXPECT_NEAR(e.localized_ratio(), 0.6, 1e-12);
  EXPECT_NEAR(e.online.rmse_m, 0.03, 1e-12);
  EXPECT_NEAR(e.smoothed.rmse_m, 0.01, 1e-12);
  EXPECT_EQ(e.wrong_fixes, 0u);
  EXPECT_FALSE(e.has_walls);
}

TEST(Evaluate, WritesTheTiltOfThePosesAsTextAndJson) {
  tools::Run run = MakeRun();
  for (runtime::StampedPose& pose : run.online) pose.T.rotate(Eigen::AngleAxisd(0.0872665, Eigen::Vector3d::UnitX()));  // 5 deg
  const Evaluation e = Evaluate(run, MakeTruth());
  EXPECT_THAT(EvaluationToText(e), HasSubstr("tilt rmse 5.00 deg, max 5.00 deg (7 poses)"));
  EXPECT_THAT(EvaluationToText(e), HasSubstr("tilt rmse 0.00 deg, max 0.00 deg (10 poses)"));
  const auto json = nlohmann::json::parse(EvaluationToJson(e));
  EXPECT_NEAR(json.at("tilt_rmse_deg").get<double>(), 5, 1e-4);
  EXPECT_NEAR(json.at("online").at("tilt_max_deg").get<double>(), 5, 1e-4);
  EXPECT_NEAR(json.at("smoothed").at("tilt_max_deg").get<double>(), 0, 1e-9);
}

TEST(Evaluate, AFarPoseIsAWrongFixOnlyWhileLocalized) {
  tools::Run run = MakeRun();
  run.online[4].T.translation().x() = 3;  // the eighth scan, `lost`
  EXPECT_EQ(Evaluate(run, MakeTruth()).wrong_fixes, 0u);
  run.online[5].T.translation().x() = 1.01;
  run.online[6].T.linear() = Eigen::AngleAxisd(0.36, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Evaluation e = Evaluate(run, MakeTruth());
  EXPECT_EQ(e.wrong_fixes, 2u);
  ASSERT_TRUE(e.first_wrong_fix_s);
  EXPECT_NEAR(*e.first_wrong_fix_s, 100.8, 1e-9);
}

TEST(Evaluate, ARunThatNeverLocalizedHasNoTime) {
  tools::Run run = MakeRun();
  for (VerdictRow& v : run.verdicts) v.verdict = "ambiguous";
  run.online.clear();
  const Evaluation e = Evaluate(run, MakeTruth());
  EXPECT_FALSE(e.time_to_localize_s);
  EXPECT_EQ(e.online.count, 0u);
  EXPECT_THAT(EvaluationToText(e), HasSubstr("never"));
  const auto json = nlohmann::json::parse(EvaluationToJson(e));
  EXPECT_TRUE(json.at("time_to_localize_s").is_null());
  EXPECT_TRUE(json.at("ate_rmse_m").is_null());
  EXPECT_TRUE(json.at("tilt_rmse_deg").is_null());
}

TEST(Evaluate, WritesTheSameFiguresAsTextAndJson) {
  Truth truth = MakeTruth();
  truth.has_walls = true;
  truth.walls = {WallTruth{"wall-A", 0.2, 0, {}, "south wall"}};
  tools::Run run = MakeRun();
  SurfaceEntry s;
  s.id = SurfaceId(4);
  s.wall_guid = "wall-A";
  s.status = "deviated";
  s.translation_m = 0.186;
  run.deviations.surfaces = {s};
  const Evaluation e = Evaluate(run, truth);
  EXPECT_EQ(e.CountWalls(WallOutcome::kFound), 1u);
  EXPECT_NEAR(e.max_translation_error_m(), 0.014, 1e-12);
  EXPECT_THAT(EvaluationToText(e), HasSubstr("1 found, 0 inaccurate, 0 missed, 0 unjudged, 0 unobserved, 0 false"));
  EXPECT_THAT(EvaluationToText(e), HasSubstr("south wall                     4 found"));
  const auto json = nlohmann::json::parse(EvaluationToJson(e));
  EXPECT_EQ(json.at("walls_found"), 1);
  EXPECT_EQ(json.at("walls").at(0).at("wall_guid"), "wall-A");
  EXPECT_EQ(json.at("walls").at(0).at("wall_name"), "south wall");
  EXPECT_NEAR(json.at("walls").at(0).at("error_translation_m").get<double>(), 0.014, 1e-12);
  EXPECT_NEAR(json.at("ate_rmse_m").get<double>(), 0.03, 1e-12);
}

TEST(EvaluateOptions, NameTheBadField) {
  EvaluateOptions options;
  EXPECT_EQ(options.Check(), "");
  options.max_truth_gap_s = 0;
  EXPECT_THAT(options.Check(), HasSubstr("max_truth_gap_s = 0"));
}

}  // namespace
}  // namespace plumb::tools
