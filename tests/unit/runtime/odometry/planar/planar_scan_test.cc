#include "runtime/odometry/planar/planar_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/planar_world.h"

namespace plumb::runtime {
namespace {

Scan Turned(Scan scan, const Eigen::Matrix3d& R) {
  for (Eigen::Vector3f& p : scan.points) p = (R * p.cast<double>()).cast<float>();
  return scan;
}

TEST(ScanPlane, OneRingIsPlanarHoweverItIsMounted) {
  const Scan scan = test::MakeLoopWorld().Sweep({}, 0, 1);
  const std::optional<Eigen::Vector3d> level = ScanPlaneNormal(scan);
  ASSERT_TRUE(level);
  EXPECT_LT((*level - Eigen::Vector3d::UnitZ()).norm(), 1e-6);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 0).normalized()).toRotationMatrix();
  const std::optional<Eigen::Vector3d> tilted = ScanPlaneNormal(Turned(scan, R));
  ASSERT_TRUE(tilted);
  EXPECT_LT((*tilted - R * Eigen::Vector3d::UnitZ()).norm(), 1e-5);
}

TEST(ScanPlane, SeveralRingsAConeOrAFewBeamsAreNot) {
  Scan scan = test::MakeLoopWorld().Sweep({}, 0, 1);
  Scan rings = scan;
  rings.ring[5] = 1;
  EXPECT_FALSE(ScanPlaneNormal(rings));
  Scan cone = scan;
  for (Eigen::Vector3f& p : cone.points) p.z() = 0.2f * p.head<2>().norm();
  EXPECT_FALSE(ScanPlaneNormal(cone));
  scan.points.resize(10);  // 5 degrees
  scan.ring.resize(10);
  EXPECT_FALSE(ScanPlaneNormal(scan));
  EXPECT_FALSE(ScanPlaneNormal(Scan()));
}

TEST(ScanPlane, IgnoresPointsThatAreNotFinite) {
  Scan scan = test::MakeLoopWorld().Sweep({}, 0, 1);
  scan.points[3].setConstant(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(ScanPlaneNormal(scan));
}

TEST(PlanarScan, NormalsFaceTheSensor) {
  const Scan scan = test::MakeLoopWorld().Sweep({{-1, 0}, 0.3}, 0, 1);
  const PlanarScan planar = MakePlanarScan(PrepareScan(scan, 0.04, 0.4, 30), Eigen::Matrix3d::Identity(), {}, 0.02);
  int with_normal = 0;
  for (const PlanarPoint& point : planar) {
    if (!point.has_normal()) continue;
    ++with_normal;
    EXPECT_NEAR(point.normal.norm(), 1, 1e-9);
    EXPECT_LT(point.normal.dot(point.p), 1e-9);
  }
  EXPECT_GT(with_normal, static_cast<int>(planar.size()) * 3 / 4);
}

TEST(PlanarScan, TakesOutTheMotionDuringTheSweep) {
  // A wall at x = 4, seen while the sensor moves 0.2 m towards it and turns by 0.1 rad.
  const Pose2 end{{0.2, 0}, 0.1};
  Scan scan;
  for (int i = 0; i <= 100; ++i) {
    const double s = i / 100.0;
    const Pose2 at{s * end.t_m, s * end.yaw_rad};
    const Eigen::Vector2d p = at.Inverse() * Eigen::Vector2d(4, 2 * s - 1);
    scan.points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), 0.0f);
    scan.time_s.push_back(static_cast<float>(0.1 * s));
  }
  for (const PlanarPoint& point : MakePlanarScan(PrepareScan(scan, 0.01, 0.4, 30), Eigen::Matrix3d::Identity(), {{}, end}, 0.02)) {
    EXPECT_NEAR(point.p.x(), 4, 1e-5);
  }
}

TEST(Leveled, SplitsAPoseAndPutsItTogetherAgain) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, -1, 0).normalized()))
                   .toRotationMatrix();
  T.translation() << 1, 2, 3;
  const LeveledPose leveled = Leveled(T);
  EXPECT_LT((leveled.Lifted().matrix() - T.matrix()).norm(), 1e-12);
  Eigen::Isometry3d turned = T;
  turned.linear() = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) * T.linear();
  EXPECT_NEAR(WrapYaw(Leveled(turned).pose.yaw_rad - leveled.pose.yaw_rad), 0.4, 1e-12);
  EXPECT_LT((Leveled(turned).leveling - leveled.leveling).norm(), 1e-12);
  EXPECT_NEAR(Leveled(Eigen::Isometry3d(Eigen::AngleAxisd(-1.2, Eigen::Vector3d::UnitZ()))).pose.yaw_rad, -1.2, 1e-12);
}

// Covariance rules against sampled derivatives.
TEST(Pose2, CovariancesOfComposedAndInverseMotionsFollowTheirDerivatives) {
  const Pose2 a{{1.2, -0.4}, 0.7}, b{{-0.5, 2.0}, -1.9};
  const auto vector = [](const Pose2& p) { return Eigen::Vector3d(p.t_m.x(), p.t_m.y(), p.yaw_rad); };
  const auto moved = [](const Pose2& p, int i, double h) {
    return Pose2{p.t_m + Eigen::Vector2d(i == 0 ? h : 0, i == 1 ? h : 0), p.yaw_rad + (i == 2 ? h : 0)};
  };
  Eigen::Matrix3d by_a, by_b, of_inverse;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 3; ++i) {
    by_a.col(i) = (vector(moved(a, i, kStep) * b) - vector(moved(a, i, -kStep) * b)) / (2 * kStep);
    by_b.col(i) = (vector(a * moved(b, i, kStep)) - vector(a * moved(b, i, -kStep))) / (2 * kStep);
    of_inverse.col(i) = (vector(moved(a, i, kStep).Inverse()) - vector(moved(a, i, -kStep).Inverse())) / (2 * kStep);
  }
  Eigen::Matrix3d A, B;
  A << 4, 1, 0.5, 1, 3, 0.2, 0.5, 0.2, 2;
  B << 2, -0.3, 0.1, -0.3, 1, 0.4, 0.1, 0.4, 3;
  EXPECT_LT((ComposedCovariance(a, A, b, B) - by_a * A * by_a.transpose() - by_b * B * by_b.transpose()).norm(), 1e-6);
  EXPECT_LT((InverseCovariance(a, A) - of_inverse * A * of_inverse.transpose()).norm(), 1e-6);
}

}  // namespace
}  // namespace plumb::runtime
