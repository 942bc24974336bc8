#include "runtime/optimization/place_seed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/synthetic_sgraph.h"

namespace plumb::runtime {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

// n walls along each axis, facing in turns; measured deviations are those of a place that is off by (dx, dy, dyaw).
struct Scene {
  std::vector<WallFrame> frames;
  std::vector<WallMeasurement> walls;
  void Add(const Eigen::Vector2d& pivot, const Eigen::Vector2d& normal, double offset_m, double yaw_rad, const Eigen::Vector3d& off,
           double bias_m) {
    WallFrame frame;
    frame.reference = SurfaceId(frames.size());
    frame.pivot << pivot, 0;
    frame.normal << normal, 0;
    WallMeasurement m;
    m.wall = WallId(frames.size());
    const Eigen::Vector2d moved = off.head<2>() + off.z() * Eigen::Vector2d(-pivot.y(), pivot.x());
    m.deviation = {offset_m + normal.dot(moved) + bias_m, yaw_rad + off.z()};
    m.bias_gain = {-1, 0};
    m.covariance = Eigen::Vector2d(0.004 * 0.004, 0.002 * 0.002).asDiagonal();
    frames.push_back(frame);
    walls.push_back(m);
  }
};

TEST(SeedPlace, UndeviatedMajorityDecides) {
  test::Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    Scene scene;
    const Eigen::Vector3d off(random.Uniform(-0.3, 0.3), random.Uniform(-0.3, 0.3), random.Uniform(-2, 2) * kDeg);
    const double bias = random.Normal(0.015);
    for (int axis = 0; axis < 2; ++axis) {
      for (int i = 0; i < 7; ++i) {
        const bool deviated = i % 7 < 3;
        const double offset = deviated ? (i % 2 ? 1 : -1) * random.Uniform(0.08, 0.35) : random.Normal(0.003);
        const double yaw = deviated ? random.Uniform(-4, 4) * kDeg : random.Normal(0.05 * kDeg);
        const Eigen::Vector2d pivot(random.Uniform(-10, 10), random.Uniform(-10, 10)),
            normal = (i % 2 ? 1 : -1) * Eigen::Vector2d(axis == 0, axis == 1);
        scene.Add(pivot, normal, offset, yaw, off, bias);
      }
    }
    const PlaceSeed seed = SeedPlace(scene.walls, scene.frames, Eigen::Isometry3d::Identity(), {});
    // The seed undoes `off`, up to second order in the turn.
    EXPECT_NEAR(seed.T_plan_map.translation().x(), -off.x(), 0.03) << trial;
    EXPECT_NEAR(seed.T_plan_map.translation().y(), -off.y(), 0.03) << trial;
    EXPECT_NEAR(std::atan2(seed.T_plan_map.linear()(1, 0), seed.T_plan_map.linear()(0, 0)), -off.z(), 0.15 * kDeg) << trial;
    EXPECT_NEAR(seed.bias_m, bias, 0.01) << trial;
  }
}

// The correction is linear in what the walls measure. Here they are measured exactly, as planes of a place that is a little off.
TEST(SeedPlace, CorrectsByWhatTheBuiltPlanesAreOffBy) {
  const Eigen::Isometry3d off = Eigen::Translation3d(8e-4, -5e-4, 0) * Eigen::AngleAxisd(4e-4, Eigen::Vector3d::UnitZ());
  constexpr double kBias_m = 6e-4;
  Scene scene;
  for (int i = 0; i < 12; ++i) {
    const double angle = 0.5 * i;
    scene.Add({3 + 4 * std::cos(2.1 * i), -2 + 5 * std::sin(1.3 * i)}, {std::cos(angle), std::sin(angle)}, 0, 0, {0, 0, 0}, 0);
    const WallFrame& frame = scene.frames.back();
    const Face face{frame.pivot, frame.normal, frame.normal, frame.pivot};
    Plane built{frame.normal, -frame.normal.dot(frame.pivot)};
    built.d -= kBias_m;  // nearer by the bias
    const FaceDeviation deviation = CompareToPlan(face, built.Transformed(off));
    scene.walls.back().deviation = {deviation.offset_m, deviation.yaw_rad};
  }
  const PlaceSeed seed = SeedPlace(scene.walls, scene.frames, Eigen::Isometry3d::Identity(), {});
  const Eigen::Isometry3d left = seed.T_plan_map * off;
  EXPECT_LT(left.translation().norm(), 0.02 * off.translation().norm());
  EXPECT_LT((left.linear() - Eigen::Matrix3d::Identity()).norm(), 0.02 * 4e-4);
  EXPECT_NEAR(seed.bias_m, kBias_m, 0.2 * kBias_m) << "which has a prior";
}

TEST(SeedPlace, KeepsTheGivenPlaceInATie) {
  Scene scene;  // two walls along x that disagree by 0.3 m: either may be the one that deviates
  scene.Add({0, 0}, {1, 0}, 0, 0, {0, 0, 0}, 0);
  scene.Add({5, 0}, {-1, 0}, 0.3, 0, {0, 0, 0}, 0);
  scene.Add({2, 3}, {0, -1}, 0, 0, {0, 0, 0}, 0);
  EXPECT_NEAR(SeedPlace(scene.walls, scene.frames, Eigen::Isometry3d::Identity(), {}).T_plan_map.translation().x(), 0, 0.02);
}

TEST(SeedPlace, AKnownPlaceOutweighsWallsThatAgreeOnAnother) {
  Scene scene;  // two fronts of furniture 0.3 m before their walls, one bare wall
  scene.Add({0, 0}, {1, 0}, 0.3, 0, {0, 0, 0}, 0);
  scene.Add({9, 0}, {1, 0}, 0.3, 0, {0, 0, 0}, 0);
  scene.Add({5, 0}, {1, 0}, 0, 0, {0, 0, 0}, 0);
  scene.Add({2, 3}, {0, -1}, 0, 0, {0, 0, 0}, 0);
  JointOptions options;
  EXPECT_NEAR(SeedPlace(scene.walls, scene.frames, Eigen::Isometry3d::Identity(), options).T_plan_map.translation().x(), -0.3, 0.05);
  options.place = Eigen::Isometry3d::Identity();
  options.place_sigma_m = 0.05;
  EXPECT_NEAR(SeedPlace(scene.walls, scene.frames, Eigen::Isometry3d::Identity(), options).T_plan_map.translation().x(), 0, 0.05);
  // From where an earlier solve may have got to: there the fronts stand as planned.
  const Eigen::Isometry3d elsewhere(Eigen::Translation3d(-0.3, 0, 0));
  Scene there;
  there.Add({0, 0}, {1, 0}, 0, 0, {0, 0, 0}, 0);
  there.Add({9, 0}, {1, 0}, 0, 0, {0, 0, 0}, 0);
  there.Add({5, 0}, {1, 0}, -0.3, 0, {0, 0, 0}, 0);
  there.Add({2, 3}, {0, -1}, 0, 0, {0, 0, 0}, 0);
  EXPECT_NEAR(SeedPlace(there.walls, there.frames, elsewhere, options).T_plan_map.translation().x(), 0, 0.05);
}

// So many walls that stand 0.3 m off at the place as known, and one that does not.
PlaceSeed SeedWithWallsAgainst(int against) {
  Scene scene;
  scene.Add({5, 0}, {1, 0}, 0, 0, {0, 0, 0}, 0);
  for (int i = 0; i < against; ++i) scene.Add({9.0 + i, 0}, {1, 0}, 0.3, 0, {0, 0, 0}, 0);
  scene.Add({2, 3}, {0, -1}, 0, 0, {0, 0, 0}, 0);
  JointOptions options;
  options.place = Eigen::Isometry3d::Identity();
  options.place_sigma_m = 0.1;
  return SeedPlace(scene.walls, scene.frames, Eigen::Isometry3d::Identity(), options);
}

TEST(SeedPlace, AMajorityOfOneDoesNotOverruleAKnownPlaceOneOfTwoDoes) {
  EXPECT_NEAR(SeedWithWallsAgainst(1).T_plan_map.translation().x(), 0, 0.02);
  EXPECT_NEAR(SeedWithWallsAgainst(2).T_plan_map.translation().x(), 0, 0.02);
  EXPECT_NEAR(SeedWithWallsAgainst(3).T_plan_map.translation().x(), -0.3, 0.02);
}

TEST(RivalPlaces, OneWallAgainstAnotherIsAnEvenBet) {
  Scene scene;  // as planned here; 0.3 m further on, the second is
  scene.Add({0, 0}, {1, 0}, 0, 0, {0, 0, 0}, 0);
  scene.Add({5, 0}, {-1, 0}, 0.3, 0, {0, 0, 0}, 0);
  scene.Add({2, 3}, {0, -1}, 0, 0, {0, 0, 0}, 0);
  const std::vector<RivalPlace> rivals = RivalPlaces(scene.walls, scene.frames, Eigen::Isometry3d::Identity(), {});
  const auto even = std::find_if(rivals.begin(), rivals.end(), [](const RivalPlace& r) { return std::abs(r.shifts[1].x() + 0.3) < 0.03; });
  ASSERT_NE(even, rivals.end());
  EXPECT_NEAR(even->log_odds, 0, 0.5);
  EXPECT_NEAR(even->shifts[0].x(), 0.3, 0.03);
  EXPECT_NEAR(even->shifts[2].x(), 0, 0.02);
}

TEST(RivalPlaces, NoneWhereMostWallsAgree) {
  Scene scene;
  for (const double x : {0.0, 2.0, 5.0}) scene.Add({x, 0}, {1, 0}, 0, 0, {0, 0, 0}, 0);
  scene.Add({7, 0}, {-1, 0}, 0.3, 0, {0, 0, 0}, 0);
  for (const double y : {0.0, 3.0}) scene.Add({2, y}, {0, -1}, 0, 0, {0, 0, 0}, 0);
  EXPECT_TRUE(RivalPlaces(scene.walls, scene.frames, Eigen::Isometry3d::Identity(), {}).empty());
  EXPECT_TRUE(RivalPlaces({}, {}, Eigen::Isometry3d::Identity(), {}).empty());
}

TEST(SeedPlace, LeavesWhatNoWallTells) {
  Scene scene;
  scene.Add({0, 0}, {1, 0}, 0.1, 0, {0, 0, 0}, 0);
  scene.Add({5, 0}, {-1, 0}, -0.1, 0, {0, 0, 0}, 0);
  const PlaceSeed seed = SeedPlace(scene.walls, scene.frames, Eigen::Isometry3d::Identity(), {});
  EXPECT_NEAR(seed.T_plan_map.translation().x(), -0.1, 0.01);
  EXPECT_NEAR(seed.T_plan_map.translation().y(), 0, 1e-6);
  EXPECT_TRUE(SeedPlace({}, {}, Eigen::Isometry3d::Identity(), {}).T_plan_map.isApprox(Eigen::Isometry3d::Identity()));
}

TEST(SupportByDirection, CountsAgreementAndTheNextCluster) {
  Scene scene;
  for (double offset : {0.0, 0.002, -0.003, 0.20, 0.0}) scene.Add({offset * 10, 0}, {1, 0}, offset, 0, {0, 0, 0}, 0);
  scene.Add({1, 1}, {-1, 0}, -0.20, 0, {0, 0, 0}, 0);  // moves the same way as the one at +0.20
  scene.Add({1, 1}, {0, 1}, 0.0, 0, {0, 0, 0}, 0);
  const auto support = SupportByDirection(scene.walls, scene.frames, 0, {});
  ASSERT_EQ(support.size(), 2u);
  EXPECT_EQ(support[0].consistent, 4);
  EXPECT_EQ(support[0].next_cluster, 2);
  EXPECT_FALSE(support[0].ambiguous());
  EXPECT_TRUE(support[1].ambiguous());  // one wall only
}

}  // namespace
}  // namespace plumb::runtime
