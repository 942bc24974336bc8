#include "tools/evaluate/pose_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumb::tools {
namespace {

constexpr double kRad = std::numbers::pi / 180;

runtime::StampedPose Pose(double stamp_s, double x, double y, double yaw_deg) {
  runtime::StampedPose pose;
  pose.stamp_s = stamp_s;
  pose.T.translation() << x, y, 0.6;
  pose.T.linear() = Eigen::AngleAxisd(yaw_deg * kRad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

TEST(ComparePoses, GivesRmseMeanAndMaxOfHandMadeErrors) {
  const runtime::Trajectory truth = {Pose(0, 0, 0, 0), Pose(0.1, 1, 0, 0), Pose(0.2, 2, 0, 0)};
  // Off by 3-4-5 cm, by nothing, and by 12 cm.
  const runtime::Trajectory estimate = {Pose(0, 0.03, 0.04, 1), Pose(0.1, 1, 0, -2), Pose(0.2, 2, -0.12, 2)};
  const PoseErrors e = ComparePoses(estimate, truth, 0.5);
  EXPECT_EQ(e.count, 3u);
  EXPECT_NEAR(e.mean_m, 0.17 / 3, 1e-12);
  EXPECT_NEAR(e.rmse_m, std::sqrt((0.0025 + 0.0144) / 3), 1e-12);
  EXPECT_NEAR(e.max_m, 0.12, 1e-12);
  EXPECT_NEAR(e.yaw_rmse_rad, std::sqrt(9.0 / 3) * kRad, 1e-9);
  EXPECT_NEAR(e.yaw_max_rad, 2 * kRad, 1e-9);
}

TEST(ComparePoses, InterpolatesTheTruthBetweenItsStamps) {
  const runtime::Trajectory truth = {Pose(10, 0, 0, 0), Pose(10.4, 1, 2, 40)};
  const PoseErrors e = ComparePoses({Pose(10.1, 0.25, 0.5, 10)}, truth, 0.5);
  EXPECT_EQ(e.count, 1u);
  EXPECT_NEAR(e.rmse_m, 0, 1e-9);
  EXPECT_NEAR(e.yaw_rmse_rad, 0, 1e-9);
}

TEST(ComparePoses, DoesNotAlign) {
  const runtime::Trajectory truth = {Pose(0, 0, 0, 0), Pose(0.1, 1, 0, 0)};
  const PoseErrors e = ComparePoses({Pose(0, 5, 0, 0), Pose(0.1, 6, 0, 0)}, truth, 0.5);
  EXPECT_NEAR(e.rmse_m, 5, 1e-12);
}

TEST(ComparePoses, WrapsYawAcrossPlusMinus180Degrees) {
  const runtime::Trajectory truth = {Pose(0, 0, 0, 179), Pose(1, 0, 0, -179)};
  const PoseErrors e = ComparePoses({Pose(0, 0, 0, -179), Pose(1, 0, 0, 179)}, truth, 0.5);
  EXPECT_EQ(e.count, 2u);
  EXPECT_NEAR(e.yaw_rmse_rad, 2 * kRad, 1e-9);
  EXPECT_NEAR(Difference(Pose(0, 0, 0, -179).T, Pose(0, 0, 0, 179).T).yaw_rad, 2 * kRad, 1e-9);
  EXPECT_NEAR(Difference(Pose(0, 0, 0, 540).T, Pose(0, 0, 0, 0).T).yaw_rad, std::numbers::pi, 1e-9);
}

TEST(ComparePoses, CountsPosesThatTheTruthDoesNotCover) {
  const runtime::Trajectory truth = {Pose(0, 0, 0, 0), Pose(0.1, 0, 0, 0), Pose(5, 0, 0, 0)};
  const PoseErrors e = ComparePoses({Pose(-1, 9, 9, 0), Pose(0.05, 0, 0, 0), Pose(2, 9, 9, 0), Pose(6, 9, 9, 0)}, truth, 0.5);
  EXPECT_EQ(e.count, 1u);
  EXPECT_EQ(e.without_truth, 3u);
  EXPECT_NEAR(e.max_m, 0, 1e-12);
}

// 5 degrees of roll and 12 of pitch tilt the vertical by acos(cos 5 cos 12).
TEST(ComparePoses, GivesRmseAndMaxOfTheTilt) {
  const runtime::Trajectory truth = {Pose(0, 0, 0, 30), Pose(0.1, 0, 0, 30), Pose(0.2, 0, 0, 30)};
  runtime::Trajectory estimate = truth;
  estimate[1].T.rotate(Eigen::AngleAxisd(5 * kRad, Eigen::Vector3d::UnitX()));
  estimate[2].T.rotate(Eigen::AngleAxisd(5 * kRad, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(12 * kRad, Eigen::Vector3d::UnitY()));
  const double both = std::acos(std::cos(5 * kRad) * std::cos(12 * kRad));
  const PoseErrors e = ComparePoses(estimate, truth, 0.5);
  EXPECT_NEAR(e.tilt_max_rad, both, 1e-9);
  EXPECT_NEAR(e.tilt_rmse_rad, std::sqrt((25 * kRad * kRad + both * both) / 3), 1e-9);
}

TEST(Difference, TiltLeavesTheTurnAboutTheVerticalOut) {
  const Eigen::Isometry3d truth = Pose(0, 0, 0, 10).T;
  Eigen::Isometry3d turned = Pose(0, 0, 0, 70).T;
  EXPECT_NEAR(Difference(turned, truth).tilt_rad, 0, 1e-9);
  turned.rotate(Eigen::AngleAxisd(-2 * kRad, Eigen::Vector3d::UnitY()));
  EXPECT_NEAR(Difference(turned, truth).tilt_rad, 2 * kRad, 1e-9);
}

TEST(Difference, YawOfATiltedSensorIsThatOfTheTurn) {
  Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
  truth.linear() =
      (Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY())).toRotationMatrix();
  Eigen::Isometry3d estimate = truth;
  estimate.linear() = Eigen::AngleAxisd(3 * kRad, Eigen::Vector3d::UnitZ()).toRotationMatrix() * truth.linear();
  EXPECT_NEAR(Difference(estimate, truth).yaw_rad, 3 * kRad, 1e-12);
}

}  // namespace
}  // namespace plumb::tools
