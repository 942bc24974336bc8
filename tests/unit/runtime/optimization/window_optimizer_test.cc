#include "runtime/optimization/window_optimizer.h"

#include <gtest/gtest.h>

#include "tests/support/house.h"
#include "tests/support/synthetic_sgraph.h"

namespace plumb::runtime {
namespace {

constexpr size_t kCount = 5;

double WorstOf(const std::vector<Eigen::Isometry3d>& poses, const test::Drive& drive) {
  const Eigen::Isometry3d T_map_plan = drive.T_plan_map.inverse();
  double worst_m = 0;
  const size_t first = drive.T_plan_kf.size() - poses.size();
  for (size_t i = 0; i < poses.size(); ++i)
    worst_m = std::max(worst_m, ((T_map_plan * drive.T_plan_kf[first + i]).inverse() * poses[i]).translation().norm());
  return worst_m;
}

// All keyframes at their true poses, the newest off as odometry drifts: the map pulls them back.
test::Drive DriveWithLostEnd(double off_m) {
  test::DriveOptions options;
  options.drift_m = options.drift_rad = 0;
  test::Drive drive = test::DriveThroughHouse(test::MakeHouse(), options);
  std::vector<Keyframe>& keyframes = drive.map.keyframes;
  for (size_t i = keyframes.size() - kCount; i < keyframes.size(); ++i) {
    keyframes[i].T_map_kf = Eigen::Translation3d(off_m, -off_m, 0) * keyframes[i].T_map_kf;
  }
  // Odometry slipped once, by as much, at the window's start.
  for (size_t i = keyframes.size() - kCount; i < keyframes.size(); ++i) keyframes[i].T_odom_kf = keyframes[i].T_map_kf;
  return drive;
}

TEST(OptimizeWindow, LaysTheNewestKeyframesOnTheMap) {
  const test::Drive drive = DriveWithLostEnd(0.03);
  std::vector<Eigen::Isometry3d> before;
  for (size_t i = drive.map.keyframes.size() - kCount; i < drive.map.keyframes.size(); ++i)
    before.push_back(drive.map.keyframes[i].T_map_kf);
  EXPECT_GT(WorstOf(before, drive), 0.03);
  const std::vector<Eigen::Isometry3d> after = OptimizeWindow(drive.map, kCount, {});
  ASSERT_EQ(after.size(), kCount);
  EXPECT_LT(WorstOf(after, drive), 0.01);
}

TEST(OptimizeWindow, SameInputSameBytes) {
  const test::Drive drive = DriveWithLostEnd(0.02);
  const auto a = OptimizeWindow(drive.map, kCount, {}), b = OptimizeWindow(drive.map, kCount, {});
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].matrix(), b[i].matrix());
}

TEST(OptimizeWindow, IsEmptyWhereTheWindowIsTheWholeMap) {
  const test::Drive drive = DriveWithLostEnd(0);
  EXPECT_TRUE(OptimizeWindow(drive.map, drive.map.keyframes.size(), {}).empty());
  EXPECT_TRUE(OptimizeWindow(drive.map, 0, {}).empty());
  EXPECT_TRUE(OptimizeWindow({}, kCount, {}).empty());
}

}  // namespace
}  // namespace plumb::runtime
