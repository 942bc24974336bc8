#include "runtime/localizer/online_localizer.h"

#include <gtest/gtest.h>

#include <cmath>

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
  for (size_t i = 0; i < count; ++i) scans.push_back(lidar.Sweep([&](double t_s) { return drive.At(t_s); }, static_cast<double>(i) * kPeriod_s));
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
