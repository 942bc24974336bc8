#include "runtime/odometry/planar/planar_registration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/odometry/planar/submap.h"
#include "tests/support/planar_world.h"

namespace plumb::runtime {
namespace {

PlanarScan ScanAt(const test::PlanarWorld& world, const Pose2& pose, uint64_t seed) {
  return MakePlanarScan(PrepareScan(world.Sweep(pose, 0, seed), 0.04, 0.4, 30), Eigen::Matrix3d::Identity(), {}, 0.02);
}

TEST(PointToLine, JacobianIsTheNumericOne) {
  const Pose2 pose{{0.4, -1.3}, 2.1}, correction{{0.02, -0.05}, 0.04};
  const PlanarPoint point{{3.2, -0.7}, {-1, 0}, 0.6};
  const Eigen::Vector2d normal(0.6, 0.8), mean(1, 2);
  const PointToLine e = EvaluatePointToLine(pose, correction, point, normal, mean);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const auto at = [&](double h) {
      const auto moved = [&](const Pose2& p, int k) {
        return Pose2{p.t_m + Eigen::Vector2d(k == 0 ? h : 0, k == 1 ? h : 0), p.yaw_rad + (k == 2 ? h : 0)};
      };
      return EvaluatePointToLine(moved(pose, i), moved(correction, i - 3), point, normal, mean).residual_m;
    };
    EXPECT_NEAR(e.jacobian[i], (at(kStep) - at(-kStep)) / (2 * kStep), 1e-7) << i;
  }
  EXPECT_NEAR(EvaluatePointToLine(pose, {}, point, normal, mean).residual_m, normal.dot(pose * point.p - mean), 1e-12);
}

TEST(PlanarRegistration, RefinesToMillimetres) {
  const test::PlanarWorld world = test::MakeLoopWorld();
  std::vector<PlanarScan> scans;
  std::vector<PlacedScan> placed;
  for (int i = 0; i < 6; ++i) scans.push_back(ScanAt(world, {{-2 + 0.2 * i, 0}, 0.1 * i}, static_cast<uint64_t>(i)));
  for (int i = 0; i < 6; ++i) placed.push_back({&scans[static_cast<size_t>(i)], {{-2 + 0.2 * i, 0}, 0.1 * i}});
  const Pose2 truth{{-1.3, 0.1}, 0.25};
  const Pose2 start{{-1.26, 0.07}, 0.265};
  const PlanarRegistration r = RegisterPlanar(ScanAt(world, truth, 9), LinesOf(placed, 0.02), start, {start, 0.2, 0.1}, {});
  ASSERT_TRUE(r.ok);
  EXPECT_LT((r.pose.t_m - truth.t_m).norm(), 0.01);
  EXPECT_NEAR(r.pose.yaw_rad, truth.yaw_rad, 0.003);
  EXPECT_GT(r.inlier_share, 0.8);
  EXPECT_LT(std::sqrt(r.covariance(0, 0)), 0.02);
  EXPECT_LT(std::sqrt(r.covariance(1, 1)), 0.02);
}

TEST(PlanarRegistration, KnowsNothingAlongACorridorWithoutEnd) {
  const double turn_rad = 0.3;  // of the corridor against the axes
  const Eigen::Vector2d along(std::cos(turn_rad), std::sin(turn_rad)), across = Perpendicular(along);
  test::PlanarWorld world;
  world.AddWall(-100 * along - across, 100 * along - across);
  world.AddWall(-100 * along + across, 100 * along + across);
  const PlanarScan scan = ScanAt(world, {{0, 0}, turn_rad}, 1);
  const std::vector<PlacedScan> placed = {{&scan, {{0, 0}, turn_rad}}};
  const Pose2 start{0.3 * along, turn_rad};
  const PlanarRegistration r =
      RegisterPlanar(ScanAt(world, {0.5 * along, turn_rad}, 2), LinesOf(placed, 0.02), start, {start, 0.2, 0.05}, {});
  ASSERT_TRUE(r.ok);
  EXPECT_NEAR(r.pose.t_m.dot(along), 0.3, 0.03);  // stays where it started
  EXPECT_NEAR(r.pose.t_m.dot(across), 0, 0.01);
  const Eigen::Matrix2d covariance = r.covariance.topLeftCorner<2, 2>();
  EXPECT_GT(std::sqrt(along.dot(covariance * along)), 0.15);
  EXPECT_LT(std::sqrt(across.dot(covariance * across)), 0.02);
  EXPECT_LT(along.dot(r.information.topLeftCorner<2, 2>() * along), 1e-3 * across.dot(r.information.topLeftCorner<2, 2>() * across));
}

TEST(LineMap, KeepsTheFacesOfAThinWallApart) {
  test::PlanarWorld world;
  world.AddWall({-2, 0}, {2, 0});
  const PlanarScan scan = ScanAt(world, {{0, -2}, 1.5707963}, 1);
  LineMap map(0.02);
  map.Insert(scan, {{0, -2}, 1.5707963});
  map.Fit();
  const LineSurfel* line = map.Nearest({0.1, 0.01}, {0, -1}, {0, -2});
  ASSERT_NE(line, nullptr);
  EXPECT_LT(line->normal.y(), -0.9);
  EXPECT_EQ(map.Nearest({0.1, 0.01}, {0, 1}, {0, 2}), nullptr);  // from behind
}

}  // namespace
}  // namespace plumb::runtime
