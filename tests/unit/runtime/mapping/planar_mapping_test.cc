// The mapper on planar lasers: walls from lines, loops closed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/mapping/mapper.h"
#include "runtime/mapping/planar_segmentation.h"
#include "tests/support/planar_world.h"

namespace plumb::runtime {
namespace {

Eigen::Isometry3d Lifted(const Pose2& pose) { return LeveledPose{pose, Eigen::Matrix3d::Identity(), 0}.Lifted(); }

std::vector<Segment> SegmentsAt(const test::PlanarWorld& world, const Pose2& pose, double noise_m = 0.01) {
  const MapperOptions options;
  KeyframeWindow window(options, 0, Lifted(pose));
  test::PlanarLaserOptions laser;
  laser.noise_m = noise_m;
  window.Add(world.Sweep(pose, 0, 1, laser), Lifted(pose), true);
  return ExtractLineSegments(window, options);
}

TEST(LineSegments, ARoomsWallsAreVerticalPlanesSeenAtOneHeight) {
  test::PlanarWorld world;
  world.AddBox({-1, -2}, {4, 2});
  const std::vector<Segment> segments = SegmentsAt(world, {});
  ASSERT_EQ(segments.size(), 3u);  // the one behind is out of sight
  for (const Segment& segment : segments) {
    EXPECT_EQ(segment.kind, SurfaceKind::kWall);
    EXPECT_NEAR(segment.plane.n.z(), 0, 1e-9);
    EXPECT_GT(segment.plane.d, 0);  // faces the sensor
    EXPECT_NEAR(segment.plane.d, std::abs(segment.plane.n.x()) > 0.5 ? 4 : 2, 0.01);
    for (const Eigen::Vector3f& cell : segment.cells) EXPECT_NEAR(cell.z(), 0, 1e-6);
    // Height counts as even over 10 cm.
    EXPECT_NEAR(segment.stats.C(2, 2) / segment.stats.count(), 0.1 * 0.1 / 12, 1e-6);
  }
}

TEST(LineSegments, ATiltedLaserSeesWallsUprightAllTheSame) {
  test::PlanarWorld world;
  world.AddBox({-1, -2}, {4, 2});
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const MapperOptions options;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = tilt.transpose();
  KeyframeWindow window(options, 0, T);
  Scan scan = world.Sweep({}, 0, 1);
  for (Eigen::Vector3f& p : scan.points) p = tilt.cast<float>() * p;
  window.Add(scan, T, true);
  for (const Segment& segment : ExtractLineSegments(window, options)) EXPECT_NEAR((T.linear() * segment.plane.n).z(), 0, 1e-6);
}

TEST(LineSegments, StepsAndShortPiecesStayApart) {
  test::PlanarWorld world;
  world.AddWall({3, -3}, {3, 0});
  world.AddWall({3, 0}, {3.3, 0});
  world.AddWall({3.3, 0}, {3.3, 3});
  world.AddWall({1, 1}, {1, 1.2});  // a post
  const std::vector<Segment> segments = SegmentsAt(world, {});
  ASSERT_EQ(segments.size(), 2u);
  std::vector<double> offsets = {segments[0].plane.d, segments[1].plane.d};
  std::sort(offsets.begin(), offsets.end());
  EXPECT_NEAR(offsets[0], 3.0, 0.01);
  EXPECT_NEAR(offsets[1], 3.3, 0.01);
}

struct Mapped {
  double odometry_m = 0, map_m = 0;  // worst keyframe, aligned at the start
  SGraph graph;
  Eigen::Isometry3d T_map_odom = Eigen::Isometry3d::Identity();
};

// Perfect scans at poses of an odometry that turns by a little too much on every metre.
Mapped MapLoop(double bias_radpm) {
  const test::PlanarWorld world = test::MakeLoopWorld();
  const std::vector<Pose2> drive = test::LoopDrive(0.4);
  Mapper mapper;
  Pose2 odom;
  const Eigen::Matrix3d step = Eigen::Vector3d(1e-4, 1e-4, 4e-5).asDiagonal();
  std::vector<Pose2> odoms;
  for (size_t i = 0; i < drive.size(); ++i) {
    if (i > 0) {
      const Pose2 moved = Between(drive[i - 1], drive[i]);
      odom = odom * Pose2{moved.t_m, moved.yaw_rad + bias_radpm * moved.t_m.norm()};
    }
    odoms.push_back(odom);
    mapper.AddScan(world.Sweep(drive[i], 0.5 * static_cast<double>(i), i), Lifted(odom), step);
  }
  mapper.Flush();
  Mapped mapped;
  mapped.graph = mapper.graph();
  mapped.T_map_odom = mapper.T_map_odom();
  for (const Keyframe& keyframe : mapped.graph.keyframes) {
    const Pose2 truth = Between(drive[0], drive[static_cast<size_t>(std::lround(keyframe.stamp_s / 0.5))]);
    mapped.odometry_m = std::max(mapped.odometry_m, (keyframe.T_odom_kf.translation().head<2>() - truth.t_m).norm());
    mapped.map_m = std::max(mapped.map_m, (keyframe.T_map_kf.translation().head<2>() - truth.t_m).norm());
  }
  return mapped;
}

TEST(PlanarMapper, ClosesTheLoopAndLeavesOdometrysFrameAlone) {
  const Mapped mapped = MapLoop(0.0025);
  EXPECT_GT(mapped.odometry_m, 0.5);
  EXPECT_LT(mapped.map_m, 0.5 * mapped.odometry_m);
  EXPECT_GT(mapped.T_map_odom.translation().norm() + std::abs(mapped.T_map_odom.linear()(1, 0)), 0.02);
  const Keyframe& newest = mapped.graph.keyframes.back();
  EXPECT_LT((mapped.T_map_odom.matrix() * newest.T_odom_kf.matrix() - newest.T_map_kf.matrix()).norm(), 1e-6);
}

TEST(PlanarMapper, WithoutDriftNothingIsBent) {
  const Mapped mapped = MapLoop(0);
  EXPECT_LT(mapped.map_m, 0.03);
}

TEST(PlanarMapper, WallsComeOutOnceWithTheHeightThatWasSeen) {
  const Mapped mapped = MapLoop(0);
  int on_north = 0;
  for (const MapSurface& s : mapped.graph.surfaces) {
    if (s.observations.empty()) continue;
    EXPECT_EQ(s.kind, SurfaceKind::kWall);
    EXPECT_NEAR(s.z_min_m, -0.05, 0.005);
    EXPECT_NEAR(s.z_max_m, 0.05, 0.005);
    // The corridor's far wall, y = 9 in the world; the drive starts at (-2, 0) or a turn beyond.
    const bool north = s.plane.n.y() < -0.99 && std::abs(s.plane.d - 9) < 0.1 && s.length_m() > 4;
    on_north += north ? 1 : 0;
  }
  EXPECT_GE(on_north, 1);
  EXPECT_LE(on_north, 2);  // a niche interrupts it
}

TEST(PlanarMapper, IsTheSameEveryTime) {
  const Mapped a = MapLoop(0.0025), b = MapLoop(0.0025);
  ASSERT_EQ(a.graph.keyframes.size(), b.graph.keyframes.size());
  for (size_t i = 0; i < a.graph.keyframes.size(); ++i)
    EXPECT_EQ(a.graph.keyframes[i].T_map_kf.matrix(), b.graph.keyframes[i].T_map_kf.matrix());
  ASSERT_EQ(a.graph.surfaces.size(), b.graph.surfaces.size());
}

}  // namespace
}  // namespace plumb::runtime
