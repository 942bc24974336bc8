#include "runtime/odometry/odometry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <functional>
#include <limits>

#include "tests/support/house.h"
#include "tests/support/synthetic_lidar.h"

namespace plumb::runtime {
namespace {

constexpr double kPeriod_s = 0.1;

struct Drift {
  double rms_m = 0, worst_m = 0, end_m = 0, worst_rad = 0;
  int failed = 0;
  std::vector<Eigen::Isometry3d> poses;
};

using GivenAt = std::function<Eigen::Isometry3d(double)>;

Drift RunDrive(const test::Drive& drive, const test::SyntheticLidarOptions& lidar_options, double duration_s, const GivenAt& given_at = {},
               const Eigen::Quaterniond& mount = Eigen::Quaterniond::Identity()) {
  const test::SyntheticLidar lidar(test::MakeHouse(), lidar_options);
  Odometry odometry;
  Drift drift;
  Eigen::Isometry3d T_plan_odom = Eigen::Isometry3d::Identity();
  double square_sum_m2 = 0;
  for (double t = 0; t + kPeriod_s < duration_s; t += kPeriod_s) {
    std::optional<Odometry::GivenMotion> given;
    if (given_at) given = {given_at(t), given_at(t + kPeriod_s)};
    const OdometryResult r = odometry.Register(lidar.Sweep([&](double s) { return drive.At(s) * mount; }, t), given);
    if (t == 0) T_plan_odom = drive.At(0) * mount * r.T_odom_lidar.inverse();
    const Eigen::Isometry3d off = (drive.At(t) * mount).inverse() * T_plan_odom * r.T_odom_lidar;
    drift.end_m = off.translation().norm();
    drift.worst_m = std::max(drift.worst_m, drift.end_m);
    drift.worst_rad = std::max(drift.worst_rad, Eigen::AngleAxisd(off.linear()).angle());
    square_sum_m2 += drift.end_m * drift.end_m;
    drift.failed += r.ok ? 0 : 1;
    drift.poses.push_back(r.T_odom_lidar);
  }
  drift.rms_m = std::sqrt(square_sum_m2 / static_cast<double>(drift.poses.size()));
  return drift;
}

test::SyntheticLidarOptions Sparse() {
  test::SyntheticLidarOptions options;
  options.azimuths = 900;
  return options;
}

TEST(Odometry, LoopThroughThreeRoomsDriftsLessThanThreeCentimetres) {
  const test::Drive drive = test::HouseDrive();
  const Drift drift = RunDrive(drive, Sparse(), drive.duration_s());
  EXPECT_EQ(drift.failed, 0);
  EXPECT_LT(drift.rms_m, 0.03);
  EXPECT_LT(drift.end_m, 0.03);
  EXPECT_LT(drift.worst_rad, 0.02);
  RecordProperty("ate_mm", static_cast<int>(1000 * drift.rms_m));
}

// Then odom's z may be the sensor's own axis, and what holds for heights does not hold along it.
TEST(Odometry, WorksHoweverTheSensorIsMounted) {
  const test::Drive drive = test::HouseDrive();
  for (const auto& [axis, angle_rad] : {std::pair(Eigen::Vector3d(0, 1, 0), 0.52), {Eigen::Vector3d(1, 0, 0), -0.52}}) {
    const Drift drift = RunDrive(drive, Sparse(), 20, {}, Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis)));
    EXPECT_EQ(drift.failed, 0) << axis.transpose() << ", " << angle_rad;
    EXPECT_LT(drift.rms_m, 0.05) << axis.transpose() << ", " << angle_rad;
  }
}

TEST(Odometry, WorksWithoutTimes) {
  test::SyntheticLidarOptions options = Sparse();
  options.with_time = false;
  const Drift drift = RunDrive(test::HouseDrive(), options, 20);
  EXPECT_LE(drift.failed, 2);
  EXPECT_LT(drift.rms_m, 0.06);
}

TEST(Odometry, FollowsTurnsBetweenRareScans) {
  // Two snapshots a second, up to 30 degrees apart.
  test::SyntheticLidarOptions options = Sparse();
  options.with_time = false;
  const test::SyntheticLidar lidar(test::MakeHouse(), options);
  const test::Drive drive = test::HouseDrive();
  Odometry odometry;
  Eigen::Isometry3d T_plan_odom = Eigen::Isometry3d::Identity();
  double worst_m = 0;
  for (double t = 0; t < 30; t += 0.5) {
    const Eigen::Isometry3d T = drive.At(t);
    const OdometryResult r = odometry.Register(lidar.Sweep([&](double) { return T; }, t), std::nullopt);
    EXPECT_TRUE(r.ok) << t;
    if (t == 0) T_plan_odom = T * r.T_odom_lidar.inverse();
    worst_m = std::max(worst_m, (T_plan_odom * r.T_odom_lidar.translation() - T.translation()).norm());
  }
  EXPECT_LT(worst_m, 0.08);
}

// A hand-held recording in a hall: no times per point, two scans a second, turns of up to 43 degrees between them.
TEST(Odometry, HandHeldRecordingStaysTogether) {
  const std::string folder = std::string(PLUMB_SOURCE_DIR) + "/../shared/data/lidar/hilti_uzh_run2";
  const Expected<Trajectory> reference = ReadTum(folder + "/reference_level.tum");
  const Expected<Recording> recording = Recording::Open(folder);
  if (!reference || !recording) GTEST_SKIP() << "no recording at " << folder;
  Odometry odometry;
  std::optional<Eigen::Isometry3d> T_reference_odom;
  double square_sum_m2 = 0;
  int count = 0;
  for (size_t i = 0; i < recording->size(); ++i) {
    const Expected<Scan> scan = recording->Read(i);
    ASSERT_TRUE(scan);
    const OdometryResult r = odometry.Register(*scan, std::nullopt);
    const std::optional<Eigen::Isometry3d> truth = InterpolatePose(*reference, scan->stamp_s, 1.0);
    if (!truth) continue;
    if (!T_reference_odom) T_reference_odom = *truth * r.T_odom_lidar.inverse();
    square_sum_m2 += (*T_reference_odom * r.T_odom_lidar.translation() - truth->translation()).squaredNorm();
    ++count;
  }
  ASSERT_GT(count, 40);
  EXPECT_LT(std::sqrt(square_sum_m2 / count), 0.3);
}

TEST(Odometry, GivenOdometryWithScaleErrorDoesNoHarm) {
  const test::Drive drive = test::HouseDrive();
  const auto given_at = [&](double t) {
    Eigen::Isometry3d T = drive.At(t);
    T.translation() *= 1.05;
    return T;
  };
  const Drift drift = RunDrive(drive, Sparse(), 20, given_at);
  EXPECT_EQ(drift.failed, 0);
  EXPECT_LT(drift.rms_m, 0.03);
}

// Heights are held unless seen: floor and ceiling show this one.
TEST(Odometry, FollowsALiftThatFloorAndCeilingShow) {
  const test::SyntheticLidar lidar(test::MakeHouse());
  const auto pose_at = [](double t) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() << 7, 3, 0.8 + 0.1 * std::clamp(t - 2.0, 0.0, 5.0);
    return T;
  };
  Odometry odometry;
  double worst_m = 0;
  for (double t = 0; t < 9; t += kPeriod_s) {
    const OdometryResult r = odometry.Register(lidar.Sweep(pose_at, t), std::nullopt);
    ASSERT_TRUE(r.ok) << t;
    worst_m = std::max(worst_m, std::abs(r.T_odom_lidar.translation().z() - (pose_at(t).translation().z() - 0.8)));
  }
  EXPECT_LT(worst_m, 0.05);
}

// Without floor and ceiling in view, and with a single wall in the first scan. Free until the axis is found, the height is off by
// decimetres.
TEST(Odometry, HoldsItsHeightThoughTheFirstScanDoesNotShowUp) {
  const test::SyntheticLidar lidar(test::MakeHouse());
  const test::Drive drive = test::HouseDrive();
  const auto only = [](const Scan& scan, const auto& keeps) {
    Scan out;
    out.stamp_s = scan.stamp_s;
    for (size_t i = 0; i < scan.points.size(); ++i) {
      if (!keeps(scan.points[i].cast<double>())) continue;
      out.points.push_back(scan.points[i]);
      out.time_s.push_back(scan.time_s[i]);
    }
    return out;
  };
  Odometry odometry;
  double square_sum_m2 = 0;
  int count = 0;
  for (double t = 0; t < 25; t += kPeriod_s, ++count) {
    const Scan sweep = lidar.Sweep([&](double at) { return drive.At(at); }, t);
    const Scan seen = only(sweep, [&](const Eigen::Vector3d& p) {
      const bool on_the_south_wall = std::abs((drive.At(0) * p).y()) < 0.08;
      return std::abs(p.z()) < 0.6 && (count > 0 || on_the_south_wall);
    });
    const OdometryResult r = odometry.Register(seen, std::nullopt);
    ASSERT_TRUE(r.ok) << t;
    square_sum_m2 += std::pow(r.T_odom_lidar.translation().z(), 2);
  }
  EXPECT_LT(std::sqrt(square_sum_m2 / count), 0.04);
}

TEST(Odometry, BrokenGivenOdometryIsIgnored) {
  const auto given_at = [&](double t) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation().x() = t > 2 ? std::numeric_limits<double>::quiet_NaN() : 1e4 * t;
    return T;
  };
  const Drift drift = RunDrive(test::HouseDrive(), Sparse(), 5, given_at);
  EXPECT_EQ(drift.failed, 0);
  EXPECT_LT(drift.rms_m, 0.03);
}

TEST(Odometry, SameInputSamePoses) {
  const test::Drive drive = test::HouseDrive();
  const Drift a = RunDrive(drive, Sparse(), 6), b = RunDrive(drive, Sparse(), 6);
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (size_t i = 0; i < a.poses.size(); ++i) EXPECT_EQ(a.poses[i].matrix(), b.poses[i].matrix()) << i;
}

// The sensor's first sweep in the house, turned by `R_world_lidar`.
Scan SweepFrom(const Eigen::Matrix3d& R_world_lidar) {
  const test::SyntheticLidar lidar(test::MakeHouse());
  return lidar.Sweep(
      [&](double) {
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.translation() << 7, 3, 1.0;
        T.linear() = R_world_lidar;
        return T;
      },
      0);
}

// Degrees between the frame's z axis and what is up.
double Lean(const OdometryResult& r, const Eigen::Matrix3d& R_world_lidar) {
  const Eigen::Vector3d up = r.T_odom_lidar.linear() * R_world_lidar.transpose() * Eigen::Vector3d::UnitZ();
  return std::acos(std::clamp(up.z(), -1.0, 1.0));
}

TEST(Odometry, LevelsATiltedStart) {
  const Eigen::Matrix3d tilt =
      (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitY())).toRotationMatrix();
  Odometry odometry;
  const OdometryResult r = odometry.Register(SweepFrom(tilt), std::nullopt);
  ASSERT_TRUE(r.ok);
  EXPECT_LT(Lean(r, tilt), 0.006);
  EXPECT_NEAR(r.T_odom_lidar.translation().norm(), 0, 1e-12);
  EXPECT_NEAR(std::atan2(r.T_odom_lidar(1, 0), r.T_odom_lidar(0, 0)), 0, 1e-9);
}

TEST(Odometry, LevelsAnyMountThatIsTold) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  for (const Eigen::Matrix3d& mount : {Eigen::AngleAxisd(M_PI, x).toRotationMatrix(), Eigen::AngleAxisd(1.5, y).toRotationMatrix(),
                                       (Eigen::AngleAxisd(2.2, x) * Eigen::AngleAxisd(0.7, y)).toRotationMatrix()}) {
    OdometryOptions options;
    options.up_in_lidar = (Eigen::AngleAxisd(0.2, y) * mount).transpose() * Eigen::Vector3d::UnitZ();  // roughly
    Odometry by_option(options);
    EXPECT_LT(Lean(by_option.Register(SweepFrom(mount), std::nullopt), mount), 0.006);
  }
}

TEST(Odometry, WhatIsSeenOutweighsAGivenOdometryOfAnyStartFrame) {
  const Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
  for (const double turn_rad : {0.2, 0.9, M_PI / 2, M_PI}) {  // of optical frames, of frames whose z axis is down
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 1, 0)}) {
      Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
      T.linear() = Eigen::AngleAxisd(turn_rad, axis.normalized()).toRotationMatrix();
      Odometry odometry;
      EXPECT_LT(Lean(odometry.Register(SweepFrom(level), Odometry::GivenMotion{T, T}), level), 0.006) << turn_rad;
    }
  }
}

TEST(Odometry, AGivenOdometryTellsUpWhereNothingSeenDoes) {
  Scan scan;  // a ball of points: no planes
  std::mt19937_64 rng(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d p(normal(rng), normal(rng), normal(rng));
    scan.points.push_back((p.normalized() * (2 + 0.5 * normal(rng))).cast<float>());
  }
  for (const double tilt_rad : {0.0, 0.3, 2.0}) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
    Odometry odometry;
    const OdometryResult r = odometry.Register(scan, Odometry::GivenMotion{T, T});
    ASSERT_TRUE(r.ok);
    EXPECT_LT(Lean(r, tilt_rad < 1 ? Eigen::Matrix3d(T.linear()) : Eigen::Matrix3d(Eigen::Matrix3d::Identity())), 1e-6) << tilt_rad;
  }
}

TEST(Odometry, DeskewedPointsLieOnTheHouse) {
  // Fast turn: undeskewed points would be off by up to 5 cm per metre of range.
  const test::SyntheticLidar lidar(test::MakeHouse());
  const auto pose_at = [](double t) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() << 7, 3, 1;
    const double ramp_s = std::min(t, 0.5);
    T.linear() = Eigen::AngleAxisd(ramp_s * ramp_s + std::max(0.0, t - 0.5), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return T;
  };
  Odometry odometry;
  OdometryResult r;
  double t = 0;
  for (; t < 1.95; t += kPeriod_s) r = odometry.Register(lidar.Sweep(pose_at, t), std::nullopt);
  const Eigen::Isometry3d T = pose_at(t - kPeriod_s);
  size_t on_east_wall = 0, near_east_wall = 0;
  for (const Eigen::Vector3f& point : r.deskewed.points) {
    const Eigen::Vector3d p = T * point.cast<double>();
    if (p.y() < 1 || p.y() > 5.5 || std::abs(p.x() - 9) > 0.5 || p.z() < 0.1 || p.z() > 2.5) continue;
    ++near_east_wall;
    on_east_wall += std::abs(p.x() - 9) < 0.06 ? 1 : 0;
  }
  EXPECT_GT(near_east_wall, 2000u);
  EXPECT_GT(static_cast<double>(on_east_wall), 0.98 * static_cast<double>(near_east_wall));
  EXPECT_EQ(r.deskewed.time_s.size(), r.deskewed.points.size());
  EXPECT_EQ(r.deskewed.ring.size(), r.deskewed.points.size());
}

TEST(Odometry, EmptyAndBrokenScansGetThePrediction) {
  const test::Drive drive = test::HouseDrive();
  const test::SyntheticLidar lidar(test::MakeHouse(), Sparse());
  Odometry odometry;
  EXPECT_FALSE(odometry.Register(Scan{}, std::nullopt).ok);
  Eigen::Isometry3d T_plan_odom = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 30; ++i) {
    const double t = kPeriod_s * i;
    Scan scan = lidar.Sweep([&](double s) { return drive.At(s); }, t);
    if (i == 10) scan = Scan{t, {}, {}, {}, {}};
    if (i == 20) {
      for (Eigen::Vector3f& p : scan.points) p.setConstant(std::numeric_limits<float>::quiet_NaN());
    }
    if (i == 25) {
      for (size_t k = 0; k < scan.points.size(); k += 2) scan.points[k].x() = std::numeric_limits<float>::infinity();
    }
    const OdometryResult r = odometry.Register(scan, std::nullopt);
    if (i == 0) T_plan_odom = drive.At(0) * r.T_odom_lidar.inverse();
    EXPECT_EQ(r.ok, i != 10 && i != 20) << i;
    EXPECT_TRUE(r.T_odom_lidar.matrix().allFinite());
    EXPECT_LT((T_plan_odom * r.T_odom_lidar.translation() - drive.At(t).translation()).norm(), 0.05) << i;
    for (const Eigen::Vector3f& p : r.deskewed.points) ASSERT_TRUE(p.allFinite());
  }
}

// Enough of them lie on some plane or other, but most pass by those that they are near: in the map they would draw the next scans off.
TEST(Odometry, ScansThatCrossTheMapAreLeftOut) {
  const test::Drive drive = test::HouseDrive();
  const test::SyntheticLidar lidar(test::MakeHouse(), Sparse());
  Odometry odometry;
  Eigen::Isometry3d T_plan_odom = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 40; ++i) {
    const double t = kPeriod_s * i;
    Scan scan = lidar.Sweep([&](double s) { return drive.At(s); }, t);
    const bool crosses = i >= 25 && i < 28;
    for (size_t k = 0; crosses && k < scan.points.size(); k += 2) scan.points[k] *= 1.06f;
    const OdometryResult r = odometry.Register(scan, std::nullopt);
    if (i == 0) T_plan_odom = drive.At(0) * r.T_odom_lidar.inverse();
    EXPECT_EQ(r.ok, !crosses) << i;
    EXPECT_FALSE(r.restarted);
    EXPECT_LT((T_plan_odom * r.T_odom_lidar.translation() - drive.At(t).translation()).norm(), 0.05) << i;
  }
}

TEST(OdometryOptions, CheckNamesTheField) {
  EXPECT_EQ(OdometryOptions().Check(), "");
  OdometryOptions options;
  options.voxel_m = -1;
  EXPECT_THAT(options.Check(), ::testing::HasSubstr("OdometryOptions.voxel_m = -1"));
}

}  // namespace
}  // namespace plumb::runtime
