#include "tools/simulate/wheel_odometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/house.h"
#include "tools/simulate/as_built.h"
#include "tools/simulate/tour.h"

namespace plumb::tools {
namespace {

Drive HouseDrive() {
  const AGraph house = test::MakeHouse();
  SimulateOptions none;
  none.deviate = 0;
  const AsBuilt built = *BuildWithDeviations(house, StoreyId(0), none);
  const FreeSpace space(built.house, StoreyId(0), built.passages);
  Random random(1);
  TourOptions options;
  options.drive.wobble_rad = 0;
  return PlanTour(built.house, space, FindReach(built.house, StoreyId(0), space), options, random)->drive;
}

SimulateOptions Exact() {
  SimulateOptions options;
  options.odometry_scale_sigma = options.odometry_yaw_bias_sigma_rad_s = options.odometry_yaw_walk_rad_sqrt_s = options.odometry_slip = 0;
  return options;
}

TEST(WheelOdometry, IsTheDriveInAnotherFrameWhenNothingDrifts) {
  const Drive drive = HouseDrive();
  const SimulateOptions options = Exact();
  const runtime::Trajectory odometry = SimulateOdometry(drive, options);
  const auto start = runtime::InterpolatePose(odometry, options.start_stamp_s);
  ASSERT_TRUE(start);
  EXPECT_GT((start->matrix() - drive.PoseAt(0).matrix()).norm(), 0.1);  // a start frame of its own
  for (double t = 0; t < drive.duration_s(); t += 5) {
    const auto T = runtime::InterpolatePose(odometry, options.start_stamp_s + t);
    ASSERT_TRUE(T);
    const Eigen::Isometry3d said = start->inverse() * *T, was = drive.PoseAt(0).inverse() * drive.PoseAt(t);
    EXPECT_TRUE(said.isApprox(was, 1e-3)) << t;
  }
}

TEST(WheelOdometry, CoversEveryFiring) {
  const Drive drive = HouseDrive();
  const SimulateOptions options;
  const runtime::Trajectory odometry = SimulateOdometry(drive, options);
  EXPECT_LT(odometry.front().stamp_s, options.start_stamp_s);
  EXPECT_GT(odometry.back().stamp_s, options.start_stamp_s + drive.duration_s() + 0.1);
  for (size_t i = 1; i < odometry.size(); ++i) ASSERT_NEAR(odometry[i].stamp_s - odometry[i - 1].stamp_s, 0.05, 1e-6);
}

TEST(WheelOdometry, DriftsSlowly) {
  const Drive drive = HouseDrive();
  SimulateOptions options;
  for (options.seed = 1; options.seed <= 10; ++options.seed) {
    const runtime::Trajectory odometry = SimulateOdometry(drive, options);
    const Eigen::Isometry3d said = odometry.front().T.inverse() * odometry.back().T;
    const Eigen::Isometry3d was = drive.PoseAt(0).inverse() * drive.PoseAt(drive.duration_s());
    const Eigen::Isometry3d error = was.inverse() * said;
    const double yaw_error_rad = std::abs(std::atan2(error.linear()(1, 0), error.linear()(0, 0)));
    EXPECT_LT(error.translation().norm(), 2.5);
    EXPECT_GT(error.translation().norm(), 0.005);
    EXPECT_LT(yaw_error_rad, 0.2);
    EXPECT_GT(yaw_error_rad, 1e-5);
  }
}

}  // namespace
}  // namespace plumb::tools
