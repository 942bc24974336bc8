#include "runtime/odometry/planar/planar_odometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "runtime/odometry/planar/planar_scan.h"
#include "tests/support/house.h"
#include "tests/support/planar_world.h"
#include "tests/support/synthetic_lidar.h"

namespace plumb::runtime {
namespace {

Eigen::Isometry3d Lifted(const Pose2& pose) { return LeveledPose{pose, Eigen::Matrix3d::Identity(), 0}.Lifted(); }

struct Drift {
  double worst_m = 0, worst_rad = 0;
  int failed = 0;
  std::vector<Eigen::Isometry3d> poses;
};

using GivenOf = std::function<Eigen::Isometry3d(size_t)>;

Drift RunDrive(const std::vector<Pose2>& drive, double period_s, const GivenOf& given = {},
               const Eigen::Isometry3d& T_laser_level = Eigen::Isometry3d::Identity()) {
  const test::PlanarWorld world = test::MakeLoopWorld();
  Odometry odometry;
  Drift drift;
  for (size_t i = 0; i < drive.size(); ++i) {
    Scan scan = world.Sweep(drive[i], period_s * static_cast<double>(i), i);
    for (Eigen::Vector3f& p : scan.points) p = T_laser_level.cast<float>() * p;
    std::optional<Odometry::GivenMotion> motion;
    if (given) motion = {given(i), given(i)};
    const OdometryResult r = odometry.Register(scan, motion);
    EXPECT_TRUE(r.planar);
    const Pose2 off = Between(Between(drive[0], drive[i]), Leveled(r.T_odom_lidar).pose);
    drift.failed += r.ok ? 0 : 1;
    drift.worst_m = std::max(drift.worst_m, off.t_m.norm());
    drift.worst_rad = std::max(drift.worst_rad, std::abs(off.yaw_rad));
    drift.poses.push_back(r.T_odom_lidar);
  }
  return drift;
}

// Wheels that turn the robot by 5 % too little and drift to the left.
GivenOf BadWheels(const std::vector<Pose2>& drive) {
  std::vector<Eigen::Isometry3d> poses;
  Pose2 at{{5, -7}, 1.1};
  for (size_t i = 0; i < drive.size(); ++i) {
    if (i > 0) {
      const Pose2 step = Between(drive[i - 1], drive[i]);
      at = at * Pose2{1.1 * step.t_m, 0.95 * step.yaw_rad + 0.05 * step.t_m.norm()};
    }
    poses.push_back(Lifted(at));
  }
  return [poses](size_t i) { return poses[i]; };
}

TEST(PlanarOdometry, FollowsHalfMetreStepsWithBadWheels) {
  const std::vector<Pose2> drive = test::LoopDrive(0.5);
  const Drift drift = RunDrive(drive, 0.7, BadWheels(drive));
  EXPECT_EQ(drift.failed, 0);
  EXPECT_LT(drift.worst_m, 0.3);  // of 90 m, where the wheels alone are metres off
  EXPECT_LT(drift.worst_rad, 0.03);
}

TEST(PlanarOdometry, NeedsNoWheels) {
  const Drift drift = RunDrive(test::LoopDrive(0.3), 0.5);
  EXPECT_EQ(drift.failed, 0);
  EXPECT_LT(drift.worst_m, 0.15);
}

TEST(PlanarOdometry, WheelsThatSpinInPlaceDoNotMoveIt) {
  std::vector<Pose2> drive = test::LoopDrive(0.4);
  drive.resize(14);  // in the room
  const GivenOf wheels = BadWheels(drive);
  const auto slipping = [&](size_t i) {
    Eigen::Isometry3d T = wheels(i);
    if (i >= 8) T = T * Eigen::Translation3d(0.7, 0, 0);  // once
    return T;
  };
  const Drift drift = RunDrive(drive, 0.7, slipping);
  EXPECT_EQ(drift.failed, 0);
  EXPECT_LT(drift.worst_m, 0.1);
}

TEST(PlanarOdometry, ATiltedMountGivesTheSamePoses) {
  std::vector<Pose2> drive = test::LoopDrive(0.4);
  drive.resize(30);
  Eigen::Isometry3d mount = Eigen::Isometry3d::Identity();
  mount.linear() = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Drift level = RunDrive(drive, 0.5), tilted = RunDrive(drive, 0.5, {}, mount);
  EXPECT_EQ(tilted.failed, 0);
  for (size_t i = 0; i < drive.size(); ++i) {
    EXPECT_LT((tilted.poses[i].translation() - level.poses[i].translation()).norm(), 0.01);
    // The scan plane is level: the lidar is tilted in it.
    EXPECT_LT((tilted.poses[i].linear() * mount.linear().col(2) - Eigen::Vector3d::UnitZ()).norm(), 1e-4);
  }
}

TEST(PlanarOdometry, IsTheSameEveryTime) {
  const std::vector<Pose2> drive = test::LoopDrive(0.5);
  const Drift a = RunDrive(drive, 0.7, BadWheels(drive)), b = RunDrive(drive, 0.7, BadWheels(drive));
  for (size_t i = 0; i < drive.size(); ++i) EXPECT_EQ(a.poses[i].matrix(), b.poses[i].matrix());
}

TEST(PlanarOdometry, CarriedElsewhereBeginsANewMapAfterASecond) {
  const test::PlanarWorld world = test::MakeLoopWorld();
  test::PlanarWorld other;
  other.AddBox({-1.5, -1.2}, {2.3, 1.7});
  Odometry odometry;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(odometry.Register(world.Sweep({{-2, 0}, 0}, 0.1 * i, static_cast<uint64_t>(i)), std::nullopt).ok);
  int restarted_at = -1;
  for (int i = 5; i < 40 && restarted_at < 0; ++i) {
    const OdometryResult r = odometry.Register(other.Sweep({}, 0.1 * i, static_cast<uint64_t>(i)), std::nullopt);
    EXPECT_FALSE(r.ok);
    if (r.restarted) restarted_at = i;
  }
  EXPECT_GE(restarted_at, 13);
  EXPECT_LE(restarted_at, 16);
  EXPECT_TRUE(odometry.Register(other.Sweep({}, 0.1 * (restarted_at + 1), 99), std::nullopt).ok);
}

TEST(PlanarOdometry, AnEmptyScanIsAPrediction) {
  const test::PlanarWorld world = test::MakeLoopWorld();
  Odometry odometry;
  EXPECT_FALSE(odometry.Register(Scan(), std::nullopt).ok);
  ASSERT_TRUE(odometry.Register(world.Sweep({{-2, 0}, 0}, 0.1, 1), std::nullopt).ok);
  Scan empty;
  empty.stamp_s = 0.2;
  const OdometryResult lost = odometry.Register(empty, std::nullopt);
  EXPECT_FALSE(lost.ok);
  EXPECT_FALSE(lost.restarted);
  EXPECT_GT(lost.step_covariance(0, 0), 0);
  EXPECT_TRUE(odometry.Register(world.Sweep({{-1.9, 0}, 0}, 0.3, 2), std::nullopt).ok);
}

// A spinning laser at 10 Hz, turning by up to a tenth of a radian within its sweep.
TEST(PlanarOdometry, TakesOutTheMotionOfASpinningLaser) {
  test::SyntheticLidarOptions options;
  options.rings = 1;
  options.azimuths = 720;
  const test::SyntheticLidar lidar(test::MakeHouse(), options);
  const test::Drive drive = test::HouseDrive();
  Odometry odometry;
  Eigen::Isometry3d T_plan_odom = Eigen::Isometry3d::Identity();
  double worst_m = 0;
  int failed = 0;
  for (double t = 0; t + 0.1 < drive.duration_s(); t += 0.1) {
    const OdometryResult r = odometry.Register(lidar.Sweep([&](double s) { return drive.At(s); }, t), std::nullopt);
    EXPECT_TRUE(r.planar && r.timed);
    if (t == 0) T_plan_odom = drive.At(0) * r.T_odom_lidar.inverse();
    failed += r.ok ? 0 : 1;
    worst_m = std::max(worst_m, (drive.At(t).translation() - T_plan_odom * r.T_odom_lidar.translation()).norm());
  }
  EXPECT_EQ(failed, 0);
  EXPECT_LT(worst_m, 0.03);
}

}  // namespace
}  // namespace plumb::runtime
