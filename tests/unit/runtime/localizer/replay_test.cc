#include "runtime/localizer/replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "runtime/rooms/sgraph_json.h"
#include "tests/support/house.h"
#include "tests/support/synthetic_lidar.h"
#include "tests/support/temporary_folder.h"

namespace plumb::runtime {
namespace {

constexpr double kPeriod_s = 0.1;

// A drive through the house as a recording on disk; once for all tests.
class Replay : public ::testing::Test {
 protected:
  static constexpr size_t kScans = 140;

  static void SetUpTestSuite() {
    house_ = new AGraph(test::MakeHouse());
    folder_ = new test::TemporaryFolder();
    std::filesystem::create_directories(*folder_ / "scans");
    test::SyntheticLidarOptions sparse;
    sparse.azimuths = 600;
    const test::SyntheticLidar lidar(*house_, sparse);
    const test::Drive drive = test::HouseDrive();
    for (size_t i = 0; i < kScans; ++i) {
      const double stamp_s = static_cast<double>(i) * kPeriod_s;
      const Scan scan = lidar.Sweep([&](double t_s) { return drive.At(t_s); }, stamp_s);
      ASSERT_TRUE(WritePcd(scan, *folder_ / ("scans/" + ScanFileName(stamp_s))));
    }
  }
  static void TearDownTestSuite() {
    delete house_;
    delete folder_;
  }

  static Recording Open() { return *Recording::Open(folder_->path()); }

  static AGraph* house_;
  static test::TemporaryFolder* folder_;
};

AGraph* Replay::house_ = nullptr;
test::TemporaryFolder* Replay::folder_ = nullptr;

// All that a run writes but for times.
std::string Outcome(const Recording& recording, const AGraph& plan, int threads) {
  Localizer localizer(plan);
  ReplayOptions options;
  options.threads = threads;
  std::string out;
  Trajectory online;
  ReplayOffline(recording, options, localizer, [&](const ReplayedScan& scan) {
    out += std::to_string(scan.index) + VerdictName(scan.verdict.verdict) + std::to_string(scan.verdict.hypotheses) + "\n";
    if (scan.verdict.T_plan_lidar) online.push_back({scan.verdict.stamp_s, *scan.verdict.T_plan_lidar});
    return true;
  });
  localizer.Finish();
  return out + WriteTum(online) + WriteTum(localizer.SmoothedTrajectory()) +
         SGraphToJson(localizer.map(), DeriveUpperLayers(localizer.map()), localizer.T_plan_map()) +
         DeviationsToJson(plan, localizer.Deviations());
}

TEST_F(Replay, GivesTheSameBytesForAnyNumberOfThreads) {
  const Recording recording = Open();
  const std::string one = Outcome(recording, *house_, 1);
  EXPECT_THAT(one, ::testing::HasSubstr("139localized"));
  EXPECT_EQ(one, Outcome(recording, *house_, 2));
  EXPECT_EQ(one, Outcome(recording, *house_, 3));
}

// Twice around a building without a plan. Odometry sees three metres far and forgets, so it drifts, and what loops take out moves the map.
TEST(ReplayWithoutAPlan, ClosesLoopsToTheSameBytesForAnyNumberOfThreads) {
  test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "scans");
  test::SyntheticLidarOptions sparse;
  sparse.azimuths = 300;
  sparse.noise_m = 0.03;
  const test::SyntheticLidar lidar(test::MakeHouse(), sparse);
  const test::Drive drive = test::HouseDrive(2);
  for (double stamp_s = 0; stamp_s < drive.duration_s(); stamp_s += 3 * kPeriod_s) {
    const Scan scan = lidar.Sweep([&](double t_s) { return drive.At(t_s); }, stamp_s);
    ASSERT_TRUE(WritePcd(scan, folder / ("scans/" + ScanFileName(stamp_s))));
  }
  const Recording recording = *Recording::Open(folder.path());
  LocalizerOptions options;
  options.odometry.max_voxels = 1000;
  options.odometry.max_range_m = 3;
  const AGraph no_plan;
  const auto map = [&](int threads) {
    Localizer localizer(no_plan, options);
    ReplayOptions replay;
    replay.threads = threads;
    ReplayOffline(recording, replay, localizer, [](const ReplayedScan&) { return true; });
    EXPECT_GE(localizer.map().loops.size(), 2u);
    const Keyframe& newest = localizer.map().keyframes.back();
    EXPECT_GT((newest.T_map_kf.translation() - newest.T_odom_kf.translation()).norm(), 0.01) << "no loop moved anything";
    return SGraphToJson(localizer.map(), DeriveUpperLayers(localizer.map()), std::nullopt);
  };
  const std::string one = map(1);
  EXPECT_EQ(one, map(2));
  EXPECT_EQ(one, map(3));
}

TEST_F(Replay, EndsWhenTheSinkHasHadEnough) {
  const Recording recording = Open();
  for (const int threads : {1, 2, 3}) {
    Localizer localizer(*house_);
    ReplayOptions options;
    options.threads = threads;
    size_t count = 0;
    ReplayOffline(recording, options, localizer, [&](const ReplayedScan&) { return ++count < 5; });
    EXPECT_EQ(count, 5u) << threads;
  }
}

TEST_F(Replay, StopsAfterTheDurationAskedFor) {
  const Recording recording = Open();
  Localizer localizer(*house_);
  ReplayOptions options;
  options.max_duration_s = 1.05;
  size_t count = 0;
  ReplayOffline(recording, options, localizer, [&](const ReplayedScan&) { return ++count > 0; });
  EXPECT_EQ(count, 11u);
}

TEST_F(Replay, HandsOnScansThatCannotBeReadAndGoesOn) {
  test::TemporaryFolder broken;
  std::filesystem::copy(*folder_ / "scans", broken / "scans");
  std::ofstream(broken / ("scans/" + ScanFileName(0.3))) << "no scan";
  const auto recording = Recording::Open(broken.path());
  ASSERT_TRUE(recording);
  for (const int threads : {1, 3}) {
    Localizer localizer(*house_);
    ReplayOptions options;
    options.threads = threads;
    std::vector<size_t> unreadable;
    size_t next = 0;
    ReplayOffline(*recording, options, localizer, [&](const ReplayedScan& scan) {
      EXPECT_EQ(scan.index, next++);
      if (scan.unreadable) unreadable.push_back(scan.index);
      return next < 8;
    });
    EXPECT_EQ(unreadable, std::vector<size_t>{3}) << threads;
  }
}

TEST_F(Replay, PacedGivesEveryScanAVerdictAndFindsTheRobot) {
  const Recording recording = Open();
  OnlineLocalizer localizer(*house_);
  ReplayOptions options;
  options.rate = 2;
  std::vector<ReplayedScan> scans;
  ReplayPaced(recording, options, localizer, [&](const ReplayedScan& scan) {
    scans.push_back(scan);
    return true;
  });
  ASSERT_EQ(scans.size(), kScans);
  for (const ReplayedScan& scan : scans) EXPECT_GT(scan.latency_ms, 0);
  Localizer& result = localizer.Drain();
  result.Finish();
  EXPECT_TRUE(result.T_plan_map());
  EXPECT_EQ(result.SmoothedTrajectory().size(), kScans);
}

TEST(ReplayOptions, CheckNamesFieldValueAndRule) {
  EXPECT_EQ(ReplayOptions{}.Check(), "");
  ReplayOptions options;
  options.threads = -1;
  EXPECT_EQ(options.Check(), "ReplayOptions.threads = -1; must be >= 0");
  options = {};
  options.online.max_scans_behind = 2;
  EXPECT_EQ(options.Check(), "OnlineOptions.max_scans_behind = 2; must be >= hold_solves_behind");
}

}  // namespace
}  // namespace plumb::runtime
