#include "runtime/localizer/online_localizer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/house.h"
#include "tests/support/synthetic_lidar.h"

namespace plumb::runtime {
namespace {

constexpr double kPeriod_s = 0.1;

// Scans of a drive through the house.
std::vector<Scan> HouseScans(const AGraph& house, size_t count) {
  test::SyntheticLidarOptions sparse;
  sparse.azimuths = 600;
  const test::SyntheticLidar lidar(house, sparse);
  const test::Drive drive = test::HouseDrive();
  std::vector<Scan> scans;
  for (size_t i = 0; i < count; ++i)
    scans.push_back(lidar.Sweep([&](double t_s) { return drive.At(t_s); }, static_cast<double>(i) * kPeriod_s));
  return scans;
}

// Fed faster than the graph can follow: every scan gets its verdict, the graph leaves out points, and nothing that was registered is lost.
TEST(OnlineLocalizer, GivesEveryScanAVerdictWhenTheGraphFallsBehind) {
  const AGraph house = test::MakeHouse();
  OnlineOptions tight;
  tight.hold_solves_behind = 1;
  tight.max_scans_behind = 2;
  OnlineLocalizer localizer(house, {}, tight);
  const std::vector<Scan> scans = HouseScans(house, 120);
  for (const Scan& scan : scans) EXPECT_EQ(localizer.AddScan(scan, std::nullopt).stamp_s, scan.stamp_s);
  Localizer& result = localizer.Drain();
  EXPECT_GT(localizer.counts().held_solves + localizer.counts().unmapped_scans, 0u);
  EXPECT_FALSE(localizer.TakeGraphTimes().empty());
  EXPECT_TRUE(localizer.TakeGraphTimes().empty());
  ASSERT_TRUE(result.T_plan_map());  // the graph saw all scans in the end, though not all of their points
  EXPECT_EQ(result.SmoothedTrajectory().size(), scans.size());
}

TEST(OnlineLocalizer, TakesInAllScansBeforeItGivesResults) {
  const AGraph house = test::MakeHouse();
  OnlineOptions roomy;
  roomy.hold_solves_behind = roomy.max_scans_behind = 200;
  OnlineLocalizer localizer(house, {}, roomy);
  Localizer in_sequence(house);
  for (const Scan& scan : HouseScans(house, 100)) {
    (void)localizer.AddScan(scan, std::nullopt);
    (void)in_sequence.AddScan(scan, std::nullopt);
  }
  const Localizer& result = localizer.Drain();
  EXPECT_EQ(localizer.counts().held_solves, 0u);
  EXPECT_EQ(localizer.counts().unmapped_scans, 0u);
  // The graph saw the same scans in the same order.
  ASSERT_EQ(result.T_plan_map().has_value(), in_sequence.T_plan_map().has_value());
  ASSERT_TRUE(result.T_plan_map());
  EXPECT_EQ(result.T_plan_map()->matrix(), in_sequence.T_plan_map()->matrix());
  EXPECT_EQ(result.SmoothedTrajectory().size(), 100u);
}

TEST(OnlineLocalizer, AnswersARequestWithoutChangingTheResult) {
  const AGraph house = test::MakeHouse();
  const std::vector<Scan> scans = HouseScans(house, 100);
  Localizer undisturbed(house);
  LocalizerOptions options;
  std::vector<EstimateUpdate> requested, of_itself;
  options.on_update = [&](const EstimateUpdate& update) { requested.push_back(update); };
  Localizer asked(house, options);
  options.on_update = [&](const EstimateUpdate& update) { of_itself.push_back(update); };
  options.update_every_solve = true;
  Localizer telling(house, options);
  for (size_t i = 0; i < scans.size(); ++i) {
    (void)undisturbed.AddScan(scans[i], std::nullopt);
    if (i == 5 || i == 95) asked.RequestUpdate();
    (void)asked.AddScan(scans[i], std::nullopt);
    (void)telling.AddScan(scans[i], std::nullopt);
  }
  ASSERT_TRUE(undisturbed.T_plan_map());
  EXPECT_EQ(asked.T_plan_map()->matrix(), undisturbed.T_plan_map()->matrix());
  EXPECT_EQ(telling.T_plan_map()->matrix(), undisturbed.T_plan_map()->matrix());
  ASSERT_EQ(requested.size(), 2u);
  EXPECT_EQ(requested[0].stamp_s, scans[5].stamp_s);
  EXPECT_EQ(requested[0].verdict, Verdict::kSearching);
  EXPECT_EQ(requested[1].verdict, Verdict::kLocalized);
  const auto judged = [](const EstimateUpdate& update) {
    return std::any_of(update.deviations.surfaces.begin(), update.deviations.surfaces.end(),
                       [](const SurfaceDeviation& s) { return s.status != SurfaceStatus::kUnobserved; });
  };
  EXPECT_FALSE(judged(requested[0]));
  EXPECT_TRUE(judged(requested[1]));
  ASSERT_GT(of_itself.size(), 1u);
  EXPECT_FALSE(of_itself.back().requested);
  EXPECT_TRUE(judged(of_itself.back()));
}

// The house with the faces of one wall off its triangles: what is seen there is in the plan, but is not these faces.
AGraph HouseWithFacesOff(WallId wall) {
  AGraph plan = test::MakeHouse();
  for (Surface& s : plan.surfaces) {
    if (s.wall != wall) continue;
    const Eigen::Vector2d shift(0.06, 0);
    s.start += shift;
    s.end += shift;
    s.d_m -= s.normal.head<2>().dot(shift);
  }
  return plan;
}

TEST(OnlineLocalizer, LeavesOutOtherShapesOfThePlanOnRequestAsInTheEnd) {
  const AGraph house = test::MakeHouse();
  const auto middle =
      std::find_if(house.walls.begin(), house.walls.end(), [](const Wall& w) { return w.guid == "wall-middle"; }) - house.walls.begin();
  const AGraph plan = HouseWithFacesOff(WallId(static_cast<size_t>(middle)));
  LocalizerOptions options;
  std::vector<EstimateUpdate> told;
  options.on_update = [&](const EstimateUpdate& update) { told.push_back(update); };
  Localizer localizer(plan, options);
  for (const Scan& scan : HouseScans(house, 100)) {
    if (scan.stamp_s > 9.85) localizer.RequestUpdate();
    (void)localizer.AddScan(scan, std::nullopt);
  }
  localizer.Finish();
  ASSERT_EQ(told.size(), 1u);
  ASSERT_EQ(told[0].verdict, Verdict::kLocalized);
  const DeviationReport end = localizer.Deviations();
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    const SurfaceDeviation& then = told[0].deviations.surfaces[i];
    EXPECT_EQ(then.status, end.surfaces[i].status) << i;
    EXPECT_NEAR(then.translation_m, end.surfaces[i].translation_m, 0.002) << i;
    EXPECT_NE(then.status, SurfaceStatus::kDeviated) << i << ": what was seen there is the wall's own shape";
  }
}

TEST(UpdateToJson, TellsOfEachSurfaceOnceUntilItChanges) {
  EstimateUpdate update;
  update.stamp_s = 12.5;
  update.verdict = Verdict::kLocalized;
  update.T_plan_map = Eigen::Isometry3d(Eigen::Translation3d(1, 2, 0.5));
  update.deviations.surfaces.resize(2);
  for (size_t i = 0; i < 2; ++i) update.deviations.surfaces[i].surface = SurfaceId(i);
  update.deviations.surfaces[1].status = SurfaceStatus::kDeviated;
  update.deviations.surfaces[1].translation_m = 0.2;
  ToldDeviations told;
  const std::string first = UpdateToJson(update, told);
  EXPECT_EQ(first,
            "{\"t\":12.5,\"verdict\":\"localized\",\"T_plan_map\":[1.0,2.0,0.5,0.0],\"surfaces\":[{\"id\":1,\"status\":\"deviated\","
            "\"translation_m\":0.2,"
            "\"sigma_translation_m\":0.0,\"rotation_deg\":0.0,\"sigma_rotation_deg\":0.0,\"p_deviated\":0.0}],\"doorways\":[]}\n");
  EXPECT_NE(UpdateToJson(update, told).find("\"surfaces\":[]"), std::string::npos);
  EstimateUpdate lost = update;
  lost.T_plan_map.reset();
  EXPECT_NE(UpdateToJson(lost, told).find("\"T_plan_map\":null"), std::string::npos);
  for (int i = 0; i < 3; ++i) {  // a drift too slow to be news from line to line is, when it adds up
    update.deviations.surfaces[1].translation_m += 0.0004;
    EXPECT_EQ(UpdateToJson(update, told).find("\"surfaces\":[]") == std::string::npos, i == 2);
  }
}

TEST(UpdateToJson, TellsOfEachDoorwayOnceUntilItChanges) {
  EstimateUpdate update;
  update.deviations.doorways = {{.doorway = DoorwayId(0), .status = DoorwayStatus::kDeviated, .shift_m = 0.1}, {.doorway = DoorwayId(1)}};
  ToldDeviations told;
  EXPECT_NE(UpdateToJson(update, told).find("\"doorways\":[{\"id\":0,\"status\":\"deviated\",\"shift_m\":0.1,"), std::string::npos);
  EXPECT_NE(UpdateToJson(update, told).find("\"doorways\":[]"), std::string::npos);
  update.deviations.doorways[1].status = DoorwayStatus::kMissing;
  EXPECT_NE(UpdateToJson(update, told).find("\"doorways\":[{\"id\":1,\"status\":\"missing\",\"shift_m\":null,"), std::string::npos);
}

TEST(OnlineLocalizer, EndsAtOnceWhenNobodyWantsTheResults) {
  const AGraph house = test::MakeHouse();
  OnlineLocalizer localizer(house);
  for (const Scan& scan : HouseScans(house, 10)) (void)localizer.AddScan(scan, std::nullopt);
}

// Odometry has begun a new map that the graph has not heard of yet: nobody knows where the robot is.
TEST(Localizer, IsLostFromTheScanOnThatBeganANewMap) {
  const AGraph house = test::MakeHouse();
  Localizer localizer(house);
  GraphState graph;
  graph.verdict = Verdict::kLocalized;
  graph.T_plan_odom = Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3));
  RegisteredScan scan;
  scan.odometry.ok = true;
  EXPECT_EQ(localizer.Track(scan, graph).verdict, Verdict::kLocalized);
  scan.odometry_map = 1;
  const ScanVerdict lost = localizer.Track(scan, graph);
  EXPECT_EQ(lost.verdict, Verdict::kLost);
  EXPECT_EQ(lost.T_plan_lidar->translation(), Eigen::Vector3d(1, 2, 3));
  graph.odometry_map = 1;
  EXPECT_EQ(localizer.Track(scan, graph).verdict, Verdict::kLocalized);
}

}  // namespace
}  // namespace plumb::runtime
