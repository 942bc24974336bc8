#include "runtime/mapping/smear.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "runtime/mapping/mapper.h"

namespace plumb::runtime {
namespace {

using Eigen::Vector3d;

Smear Moving(const Vector3d& v_m) { return {.m2 = v_m * v_m.transpose()}; }

TEST(Smear, CoversBothAndNoMore) {
  Smear smear = Moving({0.04, 0, 0});
  smear.Cover(Moving({0.02, 0, 0}));
  EXPECT_TRUE(smear.m2.isApprox(Moving({0.04, 0, 0}).m2)) << "what is smaller in every direction adds nothing";
  smear.Cover(Moving({0, 0.03, 0}));
  EXPECT_NEAR(smear.OffsetVariance_m2(Vector3d::UnitX(), Vector3d::Zero()), 0.04 * 0.04, 1e-12);
  EXPECT_NEAR(smear.OffsetVariance_m2(Vector3d::UnitY(), Vector3d::Zero()), 0.03 * 0.03, 1e-12);
  const Smear once = smear;
  smear.Cover(once);
  EXPECT_TRUE(smear.m2.isApprox(once.m2));
}

TEST(Smear, IsZeroForNoMotion) {
  Smear smear;
  smear.Cover({});
  EXPECT_EQ(smear.m2, Eigen::Matrix3d::Zero());
  EXPECT_EQ(smear.rad2, Eigen::Matrix3d::Zero());
}

TEST(Smear, ATurnMovesWhatIsFarToTheSide) {
  const Vector3d w(0, 0, 0.02);
  const Smear smear{.rad2 = w * w.transpose()};
  EXPECT_NEAR(smear.OffsetVariance_m2(Vector3d::UnitX(), {3, 0, 0}), 0, 1e-15) << "straight ahead";
  EXPECT_NEAR(smear.OffsetVariance_m2(Vector3d::UnitX(), {3, 5, 0}), 0.1 * 0.1, 1e-12);
}

Scan WallAhead() {
  Scan scan;
  for (float y = -2; y < 2; y += 0.05F) {
    for (float z = -1; z < 1; z += 0.05F) scan.points.emplace_back(5, y, z);
  }
  return scan;
}

// A robot that drives sideways by 1 m/s, heading along -x of the map: its own -y is +y there.
Keyframe KeyframeOf(bool timed) {
  Mapper mapper;
  for (int i = 0; i < 20; ++i) {
    Scan scan = WallAhead();
    scan.stamp_s = 0.1 * i;
    const Eigen::Isometry3d T = Eigen::Translation3d(0, 0.1 * i, 0) * Eigen::AngleAxisd(M_PI, Vector3d::UnitZ());
    (void)mapper.AddScan(scan, T, std::nullopt, timed);
  }
  return mapper.graph().keyframes.at(1);
}

TEST(Mapper, UntimedScansSmearAKeyframeAlongItsMotionByAUniformSpreadsDeviation) {
  const Smear smear = KeyframeOf(false).smear;
  EXPECT_NEAR(smear.m2(1, 1), 0.1 * 0.1 / 12, 1e-6);
  EXPECT_NEAR(smear.m2(0, 0), 0, 1e-12);
  EXPECT_NEAR(smear.rad2.norm(), 0, 1e-12);
}

TEST(Mapper, TimedScansSmearNothing) { EXPECT_EQ(KeyframeOf(true).smear.m2, Eigen::Matrix3d::Zero()); }

}  // namespace
}  // namespace plumb::runtime
