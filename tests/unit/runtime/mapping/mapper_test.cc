#include "runtime/mapping/mapper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/odometry/odometry.h"
#include "tests/support/house.h"
#include "tests/support/synthetic_lidar.h"

namespace plumb::runtime {
namespace {

constexpr double kPeriod_s = 0.1;

// A scan of a wall x = `x_m` and a floor, from the origin.
Scan RoomCorner(double stamp_s, double x_m) {
  Scan scan;
  scan.stamp_s = stamp_s;
  for (double y = -2; y < 2; y += 0.04) {
    for (double z = -0.9; z < 1; z += 0.06) scan.points.emplace_back(static_cast<float>(x_m), static_cast<float>(y), static_cast<float>(z));
  }
  return scan;
}

Eigen::Isometry3d At(double x_m, double yaw_rad = 0) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation().x() = x_m;
  T.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return T;
}

TEST(Mapper, ClosesKeyframesByDistance) {
  Mapper mapper;
  EXPECT_FALSE(mapper.AddScan(RoomCorner(0.0, 3), At(0)));
  EXPECT_FALSE(mapper.AddScan(RoomCorner(0.1, 2.7), At(0.3)));
  EXPECT_TRUE(mapper.AddScan(RoomCorner(0.2, 2.4), At(0.6)));
  EXPECT_EQ(mapper.graph().keyframes.size(), 1u);
  EXPECT_TRUE(mapper.Flush());
  EXPECT_FALSE(mapper.Flush());
  ASSERT_EQ(mapper.graph().keyframes.size(), 2u);
  ASSERT_EQ(mapper.graph().surfaces.size(), 1u);
  const MapSurface& wall = mapper.graph().surfaces[0];
  EXPECT_EQ(wall.observations.size(), 2u);
  EXPECT_NEAR(wall.plane.n.x(), -1, 1e-3);
  EXPECT_NEAR(wall.plane.d, 3, 1e-3);
  EXPECT_NEAR(wall.length_m(), 4, 0.15);
  EXPECT_NEAR(wall.area_m2, 4 * 1.9, 0.8);
}

TEST(Mapper, StandingStillMakesOneKeyframe) {
  Mapper mapper;
  for (int i = 0; i < 100; ++i) mapper.AddScan(RoomCorner(0.1 * i, 3), At(0));
  mapper.Flush();
  EXPECT_EQ(mapper.graph().keyframes.size(), 1u);
}

TEST(Mapper, FollowsMovedPoses) {
  Mapper mapper;
  for (int i = 0; i < 3; ++i) mapper.AddScan(RoomCorner(i, 3 - 0.6 * i), At(0.6 * i));
  mapper.Flush();
  const Eigen::Isometry3d moved = At(1.0, 0.1);
  for (Keyframe& k : mapper.mutable_graph().keyframes) k.T_map_kf = moved * k.T_map_kf;
  const double area_m2 = mapper.graph().surfaces[0].area_m2;
  mapper.OnPosesChanged();
  EXPECT_TRUE(mapper.T_map_odom().isApprox(moved, 1e-9));
  const MapSurface& wall = mapper.graph().surfaces[0];
  const Plane expected = Plane{-Eigen::Vector3d::UnitX(), 3}.Transformed(moved);
  EXPECT_TRUE(wall.plane.n.isApprox(expected.n, 1e-3));
  EXPECT_NEAR(wall.plane.d, expected.d, 2e-3);
  EXPECT_NEAR(wall.plane.SignedDistance({wall.start.x(), wall.start.y(), 0}), 0, 2e-3);
  EXPECT_NEAR(wall.length_m(), 4, 0.15);
  EXPECT_EQ(wall.area_m2, area_m2);
}

TEST(Mapper, MergesSurfacesThatPosesBringTogether) {
  Mapper mapper;
  // The second keyframe's pose is 0.5 m wrong: the wall is there twice.
  mapper.AddScan(RoomCorner(0, 3), At(0));
  mapper.AddScan(RoomCorner(3, 2.4), At(1.1));
  mapper.Flush();
  ASSERT_EQ(mapper.graph().surfaces.size(), 2u);
  mapper.mutable_graph().keyframes[1].T_map_kf = At(0.6);
  mapper.OnPosesChanged();
  EXPECT_EQ(mapper.graph().surfaces[0].observations.size(), 2u);
  EXPECT_TRUE(mapper.graph().surfaces[1].observations.empty());
  EXPECT_EQ(mapper.graph().surfaces[1].id, 1u);
}

TEST(Mapper, WallAndDoorLeafBehindItStayApart) {
  Mapper mapper;
  Scan scan;
  // A wall with a door leaf recessed by 5 cm, and noise of the same size on both.
  for (double y = -2; y < 2; y += 0.02) {
    for (double z = -0.9; z < 1; z += 0.04) {
      const double x = 3 + (y > 0.3 && y < 1.2 ? 0.05 : 0) + 0.015 * std::sin(1e4 * (y + 7 * z));
      scan.points.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    }
  }
  mapper.AddScan(scan, At(0));
  mapper.Flush();
  std::vector<const MapSurface*> large;
  for (const MapSurface& s : mapper.graph().surfaces) {
    if (s.area_m2 > 1) large.push_back(&s);
  }
  bool wall = false, leaf = false;
  for (const MapSurface* s : large) {
    wall |= std::abs(s->plane.SignedDistance({3, 0, 0})) < 0.004 && s->plane.n.x() < -0.9999;
    leaf |= std::abs(s->plane.SignedDistance({3.05, 0.75, 0})) < 0.004 && s->plane.n.x() < -0.999;
  }
  EXPECT_TRUE(wall);
  EXPECT_TRUE(leaf);
}

// What a sensor at `T` sees of two walls and a floor.
Scan ThreePlanes(double stamp_s, const Eigen::Isometry3d& T) {
  Scan scan;
  scan.stamp_s = stamp_s;
  const auto add_plane = [&](const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    for (double a = 0; a < 4; a += 0.05) {
      for (double b = 0; b < 2; b += 0.05) scan.points.push_back((T.inverse() * Eigen::Vector3d(corner + a * u + b * v)).cast<float>());
    }
  };
  add_plane({3, -2, -1}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ());
  add_plane({-1, 2, -1}, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ());
  add_plane({-1, 0, -1}, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY());
  return scan;
}

// A robot that goes to and fro, by an odometry whose third keyframe is tilted; that one goes into the first.
SGraph ToAndFro(bool hold_poses) {
  MapperOptions options;
  options.recent_keyframes = 3;
  options.well_known_views = 2;
  Mapper mapper(options);
  mapper.HoldPoses(hold_poses);
  for (int i = 0; i < 6; ++i) {
    const Eigen::Isometry3d truth = At(i % 2 == 0 ? 0.1 * i : 0.3);
    const Eigen::Isometry3d error(Eigen::AngleAxisd(i == 2 ? 0.008 : 0.0, Eigen::Vector3d::UnitX()));
    mapper.AddScan(ThreePlanes(3.0 * i, truth), truth * error);
  }
  mapper.Flush();
  return mapper.graph();
}

TEST(Mapper, AMergedKeyframeIsLaidOnTheOneItGoesInto) {
  const SGraph graph = ToAndFro(false);
  ASSERT_TRUE(graph.keyframes[2].merged);
  const uint32_t into = graph.keyframes[2].merged->into;
  const Eigen::Isometry3d T_map_kf = graph.keyframes[into].T_map_kf * graph.keyframes[2].merged->T_into_kf;
  EXPECT_LT(Eigen::AngleAxisd(T_map_kf.linear()).angle(), 0.004) << "of the 0.008 that odometry was off by";
  for (const MapSurface& surface : graph.surfaces) EXPECT_EQ(FindObservation(surface, 2), nullptr);
  for (const MapSurface& surface : graph.surfaces) {  // planes are those of what was moved
    PlaneStats sum;
    for (const Observation& o : surface.observations) sum.Add(o.stats.Transformed(graph.keyframes[o.keyframe].T_map_kf));
    EXPECT_NEAR(surface.plane.SignedDistance(sum.centroid()), 0, 1e-6);
  }
}

TEST(Mapper, AMergedKeyframeStaysWhereThePlanHoldsIt) {
  const SGraph graph = ToAndFro(true);
  ASSERT_TRUE(graph.keyframes[2].merged);
  EXPECT_NEAR(Eigen::AngleAxisd(graph.keyframes[2].T_map_kf.linear()).angle(), 0.008, 1e-6);
}

TEST(Mapper, EmptyScansMakeNoKeyframe) {
  Mapper mapper;
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(mapper.AddScan(Scan{static_cast<double>(i), {}, {}, {}, {}}, At(0.6 * i)));
  EXPECT_FALSE(mapper.Flush());
  EXPECT_TRUE(mapper.graph().keyframes.empty());
}

TEST(MapperOptions, CheckNamesTheField) {
  EXPECT_EQ(MapperOptions().Check(), "");
  MapperOptions options;
  options.plane_sigma_m = 3;
  EXPECT_THAT(options.Check(), ::testing::HasSubstr("MapperOptions.plane_sigma_m = 3"));
}

// Deskewing moves the points; lines of sight begin where the sensor was when it fired.
TEST(Mapper, StandpointsFollowTheSensorThroughASweep) {
  constexpr int kPoints = 800;
  Mapper mapper;
  for (int k = 0; k < 2; ++k) {
    Scan scan;
    scan.stamp_s = kPeriod_s * k;
    for (int i = 0; i < kPoints; ++i) {
      const double angle_rad = 2 * std::numbers::pi * i / kPoints;
      scan.points.emplace_back(3 * std::cos(angle_rad), 3 * std::sin(angle_rad), 0.1 * k);
      scan.time_s.push_back(static_cast<float>(0.1 * i / kPoints));
    }
    mapper.AddScan(scan, Eigen::Isometry3d(Eigen::Translation3d(k * kPeriod_s, 0, 0)));  // 1 m/s
  }
  mapper.Flush();
  ASSERT_EQ(mapper.graph().keyframes.size(), 1u);
  const std::vector<Keyframe::Standpoint>& standpoints = mapper.graph().keyframes[0].standpoints;
  ASSERT_GE(standpoints.size(), 9u);
  EXPECT_NEAR(standpoints.back().sensor.x(), kPeriod_s + 0.1, 0.01);
  EXPECT_NEAR(standpoints.back().sensor.x() - standpoints[standpoints.size() - 2].sensor.x(), 0.1 / 8, 1e-4);
}

}  // namespace
}  // namespace plumb::runtime
