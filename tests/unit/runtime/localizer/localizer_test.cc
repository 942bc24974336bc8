#include "runtime/localizer/localizer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/house.h"
#include "tests/support/plans.h"
#include "tests/support/synthetic_lidar.h"

namespace plumb::runtime {
namespace {

constexpr double kPeriod_s = 0.1;

test::SyntheticLidarOptions Sparse() {
  test::SyntheticLidarOptions options;
  options.azimuths = 900;
  return options;
}

struct Errors {
  double position_m, yaw_rad;
};
Errors ErrorOf(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth) {
  const Eigen::Isometry3d off = truth.inverse() * estimate;
  return {off.translation().norm(), std::abs(std::atan2(off.linear()(1, 0), off.linear()(0, 0)))};
}

// A localizer on a drive, `tilt` turning the sensor against the robot.
struct Session {
  explicit Session(const AGraph& plan, const AGraph& built, const Eigen::Quaterniond& tilt = Eigen::Quaterniond::Identity(),
                   const LocalizerOptions& options = {})
      : localizer(plan, options), lidar(built, Sparse()), T_base_lidar(tilt) {}

  [[nodiscard]] Eigen::Isometry3d TruthAt(double t_s) const { return drive.At(t_s) * T_base_lidar; }
  ScanVerdict Next() {
    Scan scan = lidar.Sweep([this](double t_s) { return TruthAt(t_s); }, time_s);
    scan.stamp_s += paused_s;
    time_s += kPeriod_s;
    return localizer.AddScan(scan, std::nullopt);
  }
  ScanVerdict NextEmpty() {
    Scan scan;
    scan.stamp_s = time_s;
    time_s += kPeriod_s;
    return localizer.AddScan(scan, std::nullopt);
  }
  // Scans until the verdict, or 0 if that is not reached by `end_s`.
  double Until(Verdict verdict, double end_s = 20) {
    while (time_s + kPeriod_s < std::min(end_s, drive.duration_s())) {
      const ScanVerdict v = Next();
      if (v.verdict == verdict) return v.stamp_s;
    }
    return 0;
  }

  Localizer localizer;
  test::SyntheticLidar lidar;
  Eigen::Isometry3d T_base_lidar;
  test::Drive drive = test::HouseDrive();
  double time_s = 0;    // of the drive
  double paused_s = 0;  // the clock is ahead of that by this
};

TEST(Localizer, FindsAndTracksTheRobotFromNothing) {
  const AGraph house = test::MakeHouse();
  Session run(house, house);
  const ScanVerdict first = run.Next();
  EXPECT_EQ(first.verdict, Verdict::kSearching);
  EXPECT_FALSE(first.T_plan_lidar);
  EXPECT_FALSE(run.localizer.T_plan_map());
  EXPECT_TRUE(run.localizer.SmoothedTrajectory().empty());
  ASSERT_GT(run.Until(Verdict::kLocalized), 0);
  int tracked = 0;
  for (; run.time_s + kPeriod_s < run.drive.duration_s(); ++tracked) {
    const ScanVerdict v = run.Next();
    ASSERT_EQ(v.verdict, Verdict::kLocalized);
    ASSERT_TRUE(v.T_plan_lidar);
    const Errors error = ErrorOf(*v.T_plan_lidar, run.TruthAt(v.stamp_s));
    EXPECT_LT(error.position_m, 0.06) << "at " << v.stamp_s;
    EXPECT_LT(error.yaw_rad, 0.01) << "at " << v.stamp_s;
  }
  EXPECT_GT(tracked, 50);
  run.localizer.Finish();
  const Trajectory smoothed = run.localizer.SmoothedTrajectory();
  ASSERT_EQ(smoothed.size(), static_cast<size_t>(std::lround(run.time_s / kPeriod_s)));  // every scan, those before the fix as well
  for (const StampedPose& pose : smoothed) EXPECT_LT(ErrorOf(pose.T, run.TruthAt(pose.stamp_s)).position_m, 0.03) << "at " << pose.stamp_s;
}

TEST(Localizer, FindsTheRobotByRoomsWithTheMatcherByGraphs) {
  const AGraph house = test::MakeHouse();
  LocalizerOptions options;
  options.matcher_kind = MatcherKind::kGraph;
  Session run(house, house, Eigen::Quaterniond::Identity(), options);
  const double found_s = run.Until(Verdict::kLocalized, 60);
  ASSERT_GT(found_s, 5) << "two rooms take their time";
  const ScanVerdict v = run.Next();
  ASSERT_TRUE(v.T_plan_lidar);
  const Errors error = ErrorOf(*v.T_plan_lidar, run.TruthAt(v.stamp_s));
  EXPECT_LT(error.position_m, 0.06);
  EXPECT_LT(error.yaw_rad, 0.01);
}

// A lidar mounted, or a robot started, at a tilt: the poses come out in the level plan frame all the same.
TEST(Localizer, LevelsASensorThatLeans) {
  const AGraph house = test::MakeHouse();
  Session run(house, house, Eigen::Quaterniond(Eigen::AngleAxisd(0.12, Eigen::Vector3d(1, 0.4, 0).normalized())));
  ASSERT_GT(run.Until(Verdict::kLocalized), 0);
  for (int i = 0; i < 30; ++i) run.Next();
  const ScanVerdict v = run.Next();
  ASSERT_TRUE(v.T_plan_lidar);
  const Eigen::Isometry3d truth = run.TruthAt(v.stamp_s);
  EXPECT_LT(ErrorOf(*v.T_plan_lidar, truth).position_m, 0.06);
  EXPECT_LT(Eigen::AngleAxisd(truth.linear().transpose() * v.T_plan_lidar->linear()).angle(), 0.02);
}

TEST(Localizer, SaysLostWhenBlindAndKeepsAPose) {
  const AGraph house = test::MakeHouse();
  Session run(house, house);
  ASSERT_GT(run.Until(Verdict::kLocalized), 0);
  const double blind_from_s = run.time_s;
  ScanVerdict v;
  for (int i = 0; i < 12; ++i) v = run.NextEmpty();
  EXPECT_EQ(v.verdict, Verdict::kLost);
  EXPECT_TRUE(v.T_plan_lidar);
  EXPECT_TRUE(run.localizer.T_plan_map());  // nobody knows where the robot is; the map is where it was
  // Sight comes back where it went: the robot is found in its map again.
  run.paused_s = run.time_s - blind_from_s;
  run.time_s = blind_from_s;
  EXPECT_EQ(run.Next().verdict, Verdict::kLocalized);
  for (int i = 0; i < 10; ++i) run.Next();
  EXPECT_LT(ErrorOf(*run.Next().T_plan_lidar, run.TruthAt(run.time_s - kPeriod_s)).position_m, 0.06);
}

TEST(Localizer, KeepsWhatItKnowsWhenTheRecordingEndsInNothing) {
  const AGraph house = test::MakeHouse();
  Session run(house, house);
  ASSERT_GT(run.Until(Verdict::kLocalized), 0);
  const size_t scans = run.localizer.SmoothedTrajectory().size();
  for (int i = 0; i < 5; ++i) (void)run.NextEmpty();
  run.localizer.Finish();
  EXPECT_TRUE(run.localizer.T_plan_map());
  EXPECT_EQ(run.localizer.SmoothedTrajectory().size(), scans);
}

TEST(Localizer, TakesNoHarmFromScansThatComeTwice) {
  const AGraph house = test::MakeHouse();
  Session run(house, house);
  ASSERT_GT(run.Until(Verdict::kLocalized), 0);
  const Scan last = run.lidar.Sweep([&](double t_s) { return run.TruthAt(t_s); }, run.time_s);
  EXPECT_EQ(run.localizer.AddScan(last, std::nullopt).verdict, Verdict::kLocalized);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(run.localizer.AddScan(last, std::nullopt).in_order);
  run.time_s += kPeriod_s;
  EXPECT_EQ(run.Next().verdict, Verdict::kLocalized);
}

// Carried from one room into another between two scans.
TEST(Localizer, IsLostNotWrongWhenCarriedOff) {
  const AGraph house = test::MakeHouse();
  Session run(house, house);
  ASSERT_GT(run.Until(Verdict::kLocalized), 0);
  for (int i = 0; i < 20; ++i) run.Next();
  const double carried_at_s = run.time_s;
  const Eigen::Vector3d before = run.TruthAt(run.time_s).translation();
  double skipped_s = 0;
  while ((run.TruthAt(run.time_s + skipped_s).translation() - before).norm() < 3.5 && skipped_s < 30) skipped_s += 0.5;
  ASSERT_LT(run.time_s + skipped_s + 8, run.drive.duration_s());
  bool was_lost = false, found_again = false;
  int wrong = 0;
  for (; run.time_s + skipped_s + kPeriod_s < run.drive.duration_s() && !found_again;) {
    Scan scan = run.lidar.Sweep([&](double t_s) { return run.TruthAt(t_s + skipped_s); }, run.time_s);
    run.time_s += kPeriod_s;
    const ScanVerdict v = run.localizer.AddScan(scan, std::nullopt);
    was_lost |= v.verdict == Verdict::kLost;
    const bool right = v.T_plan_lidar && ErrorOf(*v.T_plan_lidar, run.TruthAt(v.stamp_s + skipped_s)).position_m < 0.1;
    wrong += v.verdict == Verdict::kLocalized && !right;
    found_again = was_lost && v.verdict == Verdict::kLocalized && right;
  }
  EXPECT_TRUE(was_lost);
  EXPECT_TRUE(found_again);
  EXPECT_LE(wrong, 3) << "scans";
  // What was seen before is kept.
  const Trajectory smoothed = run.localizer.SmoothedTrajectory();
  ASSERT_FALSE(smoothed.empty());
  EXPECT_LT(smoothed.front().stamp_s, carried_at_s);
  for (const StampedPose& pose : smoothed) {
    if (pose.stamp_s < carried_at_s) { EXPECT_LT(ErrorOf(pose.T, run.TruthAt(pose.stamp_s)).position_m, 0.06) << pose.stamp_s; }
  }
}

TEST(Localizer, KeepsSearchingInAPlanOfAnotherBuilding) {
  const AGraph house = test::MakeHouse(), other = test::MakeRandomPlan(3, 4, 3);
  Session run(other, house);
  EXPECT_EQ(run.Until(Verdict::kLocalized, 10), 0);
  ASSERT_NE(run.localizer.last_try(), nullptr);
  EXPECT_FALSE(run.localizer.last_try()->result.reason.empty());
}

TEST(Localizer, PolishesAMapThatLiesInNoPlan) {
  const AGraph house = test::MakeHouse(), no_plan;
  Session run(no_plan, house);
  EXPECT_EQ(run.Until(Verdict::kLocalized, 6), 0);
  run.localizer.Finish();
  EXPECT_FALSE(run.localizer.T_plan_map());
  const std::vector<Keyframe>& keyframes = run.localizer.map().keyframes;
  ASSERT_GT(keyframes.size(), 3u);
  const Eigen::Isometry3d T_plan_map = run.TruthAt(keyframes[0].stamp_s) * keyframes[0].T_map_kf.inverse();
  for (const Keyframe& k : keyframes) {
    EXPECT_LT((k.T_odom_kf.inverse() * k.T_map_kf).translation().norm(), 0.05);
    EXPECT_LT(ErrorOf(T_plan_map * k.T_map_kf, run.TruthAt(k.stamp_s)).position_m, 0.03);
  }
  EXPECT_TRUE(
      std::any_of(keyframes.begin() + 1, keyframes.end(), [](const Keyframe& k) { return !k.T_map_kf.isApprox(k.T_odom_kf, 1e-9); }));
}

TEST(Localizer, GivesTheSamePosesForTheSameScans) {
  const AGraph house = test::MakeHouse();
  Session a(house, house), b(house, house);
  for (int i = 0; i < 80; ++i) {
    const ScanVerdict va = a.Next(), vb = b.Next();
    ASSERT_EQ(va.verdict, vb.verdict);
    ASSERT_EQ(va.T_plan_lidar.has_value(), vb.T_plan_lidar.has_value());
    if (va.T_plan_lidar) { ASSERT_EQ(va.T_plan_lidar->matrix(), vb.T_plan_lidar->matrix()); }
  }
}

// Every trouble a sensor makes, one after the other, once it is localized: the pose goes on being right.
TEST(Localizer, GoesOnThroughSensorTrouble) {
  const AGraph house = test::MakeHouse();
  Session run(house, house);
  ASSERT_GT(run.Until(Verdict::kLocalized), 0);
  for (int i = 0; run.time_s + 3 < run.drive.duration_s(); ++i) {
    Scan scan = run.lidar.Sweep([&](double t_s) { return run.TruthAt(t_s); }, run.time_s);
    run.time_s += kPeriod_s;
    switch (i % 12) {
      case 1: scan.ring.clear(); break;
      case 2: scan.intensity.clear(); break;
      case 3:
        for (size_t k = 0; k < scan.points.size(); k += 3) scan.points[k].y() = std::numeric_limits<float>::quiet_NaN();
        break;
      case 5: scan = {scan.stamp_s, {}, {}, {}, {}}; break;
      case 7: EXPECT_TRUE(run.localizer.AddScan(scan, std::nullopt).in_order); break;  // and once more
      case 9: scan.stamp_s -= 0.5; break;
      case 11: scan.time_s.assign(scan.points.size(), std::numeric_limits<float>::infinity()); break;
      default: break;
    }
    if (i == 40) run.time_s += 2;  // nothing for two seconds
    const ScanVerdict v = run.localizer.AddScan(scan, std::nullopt);
    EXPECT_EQ(v.in_order, i % 12 != 7 && i % 12 != 9);
    ASSERT_EQ(v.verdict, Verdict::kLocalized) << "at " << v.stamp_s;
    if (v.in_order && !scan.points.empty()) {
      EXPECT_LT(ErrorOf(*v.T_plan_lidar, run.TruthAt(v.stamp_s)).position_m, 0.1) << "at " << v.stamp_s;
    }
  }
  run.localizer.Finish();
  const Trajectory smoothed = run.localizer.SmoothedTrajectory();
  EXPECT_TRUE(
      std::is_sorted(smoothed.begin(), smoothed.end(), [](const StampedPose& a, const StampedPose& b) { return a.stamp_s <= b.stamp_s; }));
}

TEST(Localizer, LeavesOutScansWithoutAStamp) {
  const AGraph house = test::MakeHouse();
  Localizer localizer(house);
  Scan scan;
  scan.stamp_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(localizer.AddScan(scan, std::nullopt).in_order);
  scan.stamp_s = 1;
  EXPECT_TRUE(localizer.AddScan(scan, std::nullopt).in_order);
}

TEST(Localizer, TakesScansOfThreeHundredThousandPoints) {
  const AGraph house = test::MakeHouse();
  test::SyntheticLidarOptions dense;
  dense.rings = 128;
  dense.azimuths = 2400;
  const test::SyntheticLidar lidar(house, dense);
  const test::Drive drive = test::HouseDrive();
  Localizer localizer(house);
  ScanVerdict v;
  for (int i = 0; i < 25; ++i) {
    const Scan scan = lidar.Sweep([&](double t_s) { return drive.At(t_s); }, 0.4 * i);
    ASSERT_GT(scan.points.size(), 290000u);
    v = localizer.AddScan(scan, std::nullopt);
  }
  EXPECT_EQ(v.verdict, Verdict::kLocalized);
  for (const Keyframe& keyframe : localizer.map().keyframes)
    EXPECT_LE(keyframe.points.size(), static_cast<size_t>(MapperOptions{}.max_keyframe_points));
}

TEST(LocalizerOptions, CheckNamesFieldValueAndRule) {
  EXPECT_EQ(LocalizerOptions{}.Check(), "");
  LocalizerOptions options;
  options.lost_after = 0;
  EXPECT_EQ(options.Check(), "LocalizerOptions.lost_after = 0; must be >= 1");
  options = {};
  options.matcher.vote_cell_m = -1;
  EXPECT_EQ(options.Check(), "MatcherOptions.vote_cell_m = -1; must be in [0.02, 1]");
}

TEST(GivenMotionDuring, IsNoneWhereTheOdometryDoesNotCoverTheSweep) {
  Scan scan;
  scan.stamp_s = 10;
  scan.time_s = {0, 0.05f, 0.1f};
  const auto at = [](double t_s, double x_m) { return StampedPose{t_s, Eigen::Isometry3d(Eigen::Translation3d(x_m, 0, 0))}; };
  EXPECT_FALSE(GivenMotionDuring(scan, {}));
  EXPECT_FALSE(GivenMotionDuring(scan, {at(9.95, 0), at(10.05, 1)}));
  const auto given = GivenMotionDuring(scan, {at(9.95, 0), at(10.05, 1), at(10.15, 2)});
  ASSERT_TRUE(given);
  EXPECT_NEAR((given->T_start.inverse() * given->T_end).translation().x(), 1.0, 1e-6);
}

}  // namespace
}  // namespace plumb::runtime
