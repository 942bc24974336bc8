#include "runtime/odometry/registration.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/house.h"
#include "tests/support/synthetic_lidar.h"

namespace plumb::runtime {
namespace {

double Uniform(std::mt19937_64& rng, double lo, double hi) { return lo + (hi - lo) * static_cast<double>(rng() >> 11) * 0x1p-53; }
Eigen::Vector3d UniformVector(std::mt19937_64& rng, double size) {
  return {Uniform(rng, -size, size), Uniform(rng, -size, size), Uniform(rng, -size, size)};
}

TEST(PointToPlane, JacobianIsThatOfTheResidual) {
  std::mt19937_64 rng(7);
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = ExpSo3(UniformVector(rng, 1.5));
    T.translation() = UniformVector(rng, 5);
    const Eigen::Vector3d p = UniformVector(rng, 8), mean = UniformVector(rng, 8), center = UniformVector(rng, 5);
    const Eigen::Vector3d normal = UniformVector(rng, 1).normalized();
    const PointToPlane e = EvaluatePointToPlane(T * p, normal, mean, center);
    EXPECT_NEAR(e.residual_m, normal.dot(T * p - mean), 1e-12);
    constexpr double kStep = 1e-6;
    for (int k = 0; k < 6; ++k) {
      Vector6d step = Vector6d::Zero();
      step[k] = kStep;
      const double plus_m = normal.dot(Moved(T, step, center) * p - mean), minus_m = normal.dot(Moved(T, -step, center) * p - mean);
      EXPECT_NEAR(e.jacobian[k], (plus_m - minus_m) / (2 * kStep), 1e-6);
    }
  }
}

// The same point, moved with a sweep whose start moves by d and whose end by d + e: derivative s a by e.
TEST(PointToPlane, MotionDuringTheSweepEntersByItsFraction) {
  std::mt19937_64 rng(8);
  const SweepMotion motion{Eigen::Isometry3d::Identity(), Eigen::Isometry3d(Eigen::Translation3d(0.08, 0.02, 0))};
  for (const double s : {0.0, 0.25, 0.5, 1.0}) {  // at knots, where SweepPoses is exact
    const Eigen::Vector3d p = UniformVector(rng, 6), normal = UniformVector(rng, 1).normalized(), mean = UniformVector(rng, 6);
    const Eigen::Vector3d center = motion.T_start.translation();
    const PointToPlane e = EvaluatePointToPlane(SweepPoses(motion).Apply(p, s), normal, mean, center);
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 6; ++k) {
      Vector6d step = Vector6d::Zero();
      step[k] = kStep;
      const auto at = [&](const Vector6d& end_step) {
        return normal.dot(SweepPoses({motion.T_start, Moved(motion.T_end, end_step, center)}).Apply(p, s) - mean);
      };
      // Rotating the end about the start's place also shifts it: second order in the motion, so only about equal.
      EXPECT_NEAR(s * e.jacobian[k], (at(step) - at(-step)) / (2 * kStep), 0.06);
    }
  }
}

class RegistrationInTheHouse : public ::testing::Test {
 protected:
  RegistrationInTheHouse() {
    T_true_.translation() << 2.0, 1.8, 0.9;
    T_true_.linear() = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    test::SyntheticLidarOptions options;
    options.with_time = false;
    const test::SyntheticLidar lidar(test::MakeHouse(), options);
    for (int i = 0; i < 10; ++i) {
      // From slightly different places, as a moving robot sees a room.
      Eigen::Isometry3d T = T_true_;
      T.translation() += Eigen::Vector3d(0.03 * i, -0.02 * i, 0.01 * i);
      const PreparedScan scan = PrepareScan(lidar.Sweep([&](double) { return T; }, 0.1 * i), 0.1, 0.4, 80);
      for (const SweepPoint& point : scan.points) map_.Insert(T * point.p, T.translation());
      map_.EndScan();
    }
    scan_ = PrepareScan(lidar.Sweep([&](double) { return T_true_; }, 50), 0.1, 0.4, 80);
  }

  [[nodiscard]] SweepPrior PriorAt(const Eigen::Isometry3d& T) const {
    SweepPrior prior;
    prior.mean = {T, T};
    return prior;
  }

  Eigen::Isometry3d T_true_ = Eigen::Isometry3d::Identity();
  SurfelMap map_;
  PreparedScan scan_;
};

TEST_F(RegistrationInTheHouse, RecoversKnownMotions) {
  std::mt19937_64 rng(3);
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::Isometry3d T = T_true_;
    T.translation() += UniformVector(rng, 0.10);
    T.linear() = ExpSo3(UniformVector(rng, 0.035)) * T.linear();
    const RegistrationResult r = RegisterSweep(scan_.points, false, map_, PriorAt(T), {});
    ASSERT_TRUE(r.ok);
    const Eigen::Isometry3d off = T_true_.inverse() * r.motion.T_start;
    EXPECT_LT(off.translation().head<2>().norm(), 0.006);
    EXPECT_LT(std::abs(off.translation().z()), 0.025);
    EXPECT_LT(LogSo3(off.linear()).norm(), 0.005);
    EXPECT_NEAR(r.rms_m, 0.02, 0.006);
  }
}

TEST_F(RegistrationInTheHouse, WiderSearchRecoversLargeMotions) {
  RegistrationOptions options;
  options.search_neighbours = true;
  options.initial_kernel_m = 1.0;
  options.max_iterations = 30;
  Eigen::Isometry3d T = T_true_;
  T.translation() += Eigen::Vector3d(0.4, -0.3, 0.05);
  T.linear() = ExpSo3({0.02, -0.03, 0.12}) * T.linear();
  const RegistrationResult r = RegisterSweep(scan_.points, false, map_, PriorAt(T), options);
  ASSERT_TRUE(r.ok);
  EXPECT_LT((r.motion.T_start.translation() - T_true_.translation()).head<2>().norm(), 0.01);
}

TEST_F(RegistrationInTheHouse, NoPointsIsNoSuccess) {
  EXPECT_FALSE(RegisterSweep({}, false, map_, PriorAt(T_true_), {}).ok);
  EXPECT_FALSE(RegisterSweep(scan_.points, false, SurfelMap(), PriorAt(T_true_), {}).ok);
}

TEST(Registration, PriorDecidesAlongASmoothCorridor) {
  SurfelMap map;
  std::mt19937_64 rng(5);
  std::vector<SweepPoint> points;
  const auto wall_point = [&](double x) {
    const double side = (rng() & 1) != 0 ? 1.0 : -1.0;
    const int which = static_cast<int>(rng() % 3);
    const double noise_m = Uniform(rng, -0.03, 0.03), across_m = Uniform(rng, -1, 1);
    if (which == 0) return Eigen::Vector3d(x, across_m, -1 + noise_m);
    return Eigen::Vector3d(x, side * (1 + noise_m), across_m);
  };
  for (int i = 0; i < 30000; ++i) map.Insert(wall_point(Uniform(rng, -10, 10)), Eigen::Vector3d::Zero());
  map.EndScan();
  for (int i = 0; i < 3000; ++i) points.push_back({wall_point(Uniform(rng, -6, 6)), 0});
  SweepPrior prior;
  prior.mean.T_start.translation() << 0.5, 0.05, 0.03;
  prior.mean.T_end = prior.mean.T_start;
  prior.covariance.diagonal().setConstant(0.01);
  const RegistrationResult r = RegisterSweep(points, false, map, prior, {});
  ASSERT_TRUE(r.ok);
  EXPECT_NEAR(r.motion.T_start.translation().x(), 0.5, 0.02);
  EXPECT_NEAR(r.motion.T_start.translation().y(), 0, 0.005);
  EXPECT_NEAR(r.motion.T_start.translation().z(), 0, 0.005);
}

}  // namespace
}  // namespace plumb::runtime
