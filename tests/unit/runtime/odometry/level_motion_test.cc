#include "runtime/odometry/level_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace plumb::runtime {
namespace {

const Eigen::Matrix3d kNoNoise = Eigen::Matrix3d::Zero();

Eigen::Isometry3d Turned(double yaw_rad, double pitch_rad = 0) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() =
      (Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY())).toRotationMatrix();
  return T;
}

EstimatedSweep Driving(double speed_mps) {
  EstimatedSweep last;
  last.sweep_s = 0.1;
  last.motion.T_end.translation() << 0.1 * speed_mps, 0, 0.02;
  last.covariance = 1e-4 * Matrix12d::Identity();
  last.twist.v_mps.x() = speed_mps;
  return last;
}

double ClimbSigma_m(const LevelMotion& level, double speed_mps) {
  const EstimatedSweep last = Driving(speed_mps);
  const SweepGaussian free = PredictSweep(last, 0.1, 0.1, std::nullopt, level.up());
  return std::sqrt(level.Restrict(free, last, 0.1, 0.1).covariance(11, 11));
}

TEST(LevelMotion, RobotThatTurnsUprightStaysAtItsHeight) {
  LevelMotion level(Eigen::Vector3d::UnitZ());
  for (int i = 0; i < 100; ++i) level.Learn(Turned(0.05 * i), kNoNoise);
  EXPECT_NEAR(level.sway_rad(), 0, 1e-9);
  EXPECT_LT(ClimbSigma_m(level, 1.0), 0.001);
}

TEST(LevelMotion, SensorMountedAtATiltIsLevelAllTheSame) {
  LevelMotion level(Eigen::Vector3d::UnitZ());
  for (int i = 0; i < 100; ++i) level.Learn(Turned(0.05 * i, 0.4), kNoNoise);
  EXPECT_NEAR(level.sway_rad(), 0, 1e-9);
}

TEST(LevelMotion, RampMakesClimbingLikely) {
  LevelMotion level(Eigen::Vector3d::UnitZ());
  for (int i = 0; i < 100; ++i) level.Learn(Turned(0.02 * i), kNoNoise);
  level.Learn(Turned(2.0, 0.05), kNoNoise);
  EXPECT_GT(ClimbSigma_m(level, 1.0), 0.004);  // in 0.1 m, of which it climbs 5 mm
}

TEST(LevelMotion, CarriedSensorIsFree) {
  LevelMotion level(Eigen::Vector3d::UnitZ());
  for (int i = 0; i < 200; ++i) level.Learn(Turned(0.02 * i, 0.06 * std::sin(1.3 * i)), kNoNoise);
  EXPECT_GT(level.sway_rad(), 0.02);
  EXPECT_GT(ClimbSigma_m(level, 1.0), 0.004);
}

TEST(LevelMotion, CarriedSensorStaysFreeWhenUpIsFound) {
  LevelMotion level(Eigen::Vector3d::UnitZ());
  for (int i = 0; i < 200; ++i) level.Learn(Turned(0.02 * i, 0.06 * std::sin(1.3 * i)), kNoNoise);
  const Eigen::Vector3d up = Eigen::Vector3d(0.02, 0, 1).normalized();
  level.SetUp(up);
  EXPECT_NEAR((level.up() - up).norm(), 0, 1e-12);
  EXPECT_GT(level.sway_rad(), 0.02);
}

TEST(LevelMotion, LearnsTheAxisThatTheRobotTurnsAbout) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.01, -0.005, 1).normalized();
  LevelMotion level(Eigen::Vector3d::UnitZ());
  for (int i = 0; i < 600; ++i) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(0.02 * i, axis).toRotationMatrix();
    level.Learn(T, kNoNoise);
  }
  EXPECT_LT((level.up() - axis).norm(), 0.001);
  EXPECT_LT(level.sway_rad(), 0.001);
}

TEST(LevelMotion, NoiseOfTheAttitudeIsNoSway) {
  std::mt19937_64 rng(1);
  std::normal_distribution<double> noise(0, 0.005);
  LevelMotion level(Eigen::Vector3d::UnitZ());
  const Eigen::Matrix3d covariance = 0.005 * 0.005 * Eigen::Matrix3d::Identity();
  for (int i = 0; i < 300; ++i) level.Learn(Turned(0.02 * i, noise(rng)), covariance);
  EXPECT_LT(level.sway_rad(), 0.003);
}

TEST(LevelMotion, RestrictsHeightsAlone) {
  const LevelMotion level(Eigen::Vector3d::UnitZ());
  const EstimatedSweep last = Driving(1.0);
  const SweepGaussian free = PredictSweep(last, 0.1, 0.1, std::nullopt, level.up()), kept = level.Restrict(free, last, 0.1, 0.1);
  for (const int i : {0, 1, 2, 3, 4, 6, 7, 8, 9, 10}) EXPECT_DOUBLE_EQ(kept.covariance(i, i), free.covariance(i, i)) << i;
  EXPECT_NEAR(kept.covariance(5, 5), 2e-4, 1e-6);  // where the last sweep ended, which is as certain as its start and motion together
  EXPECT_GT(kept.covariance.llt().matrixL().determinant(), 0);
  EXPECT_DOUBLE_EQ(kept.mean.T_end.translation().z(), 0.02);
  EXPECT_DOUBLE_EQ(kept.mean.T_end.translation().x(), free.mean.T_end.translation().x());
}

}  // namespace
}  // namespace plumb::runtime
