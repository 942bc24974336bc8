#include "runtime/mapping/spatial_loops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "runtime/mapping/mapper.h"
#include "runtime/mapping/pose_graph.h"
#include "runtime/odometry/motion_prediction.h"
#include "tests/support/house.h"
#include "tests/support/synthetic_lidar.h"

namespace plumb::runtime {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Eigen::Isometry3d At(double x_m, double y_m, double yaw_rad) {
  return Eigen::Translation3d(x_m, y_m, 1) * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
}

// A wall, floor or ceiling: points origin + a * u + b * v, 0 <= a, b <= 1.
struct Patch {
  Eigen::Vector3d origin, u, v;
};

std::vector<Patch> Corridor() {
  return {{{-15, -1, 0}, {30, 0, 0}, {0, 0, 2.5}},
          {{-15, 1, 0}, {30, 0, 0}, {0, 0, 2.5}},
          {{-15, -1, 0}, {30, 0, 0}, {0, 2, 0}},
          {{-15, -1, 2.5}, {30, 0, 0}, {0, 2, 0}}};
}

std::vector<Patch> Room() {
  return {{{-3, -2, 0}, {9, 0, 0}, {0, 0, 2.5}}, {{-3, 3, 0}, {9, 0, 0}, {0, 0, 2.5}}, {{-3, -2, 0}, {0, 5, 0}, {0, 0, 2.5}},
          {{6, -2, 0}, {0, 5, 0}, {0, 0, 2.5}},  {{-3, -2, 0}, {9, 0, 0}, {0, 5, 0}},  {{-3, -2, 2.5}, {9, 0, 0}, {0, 5, 0}}};
}

Keyframe Seen(const std::vector<Patch>& world, const Eigen::Isometry3d& truth, const Eigen::Isometry3d& believed, double travelled_m) {
  std::mt19937 rng(static_cast<unsigned>(1000 * travelled_m) + 1);
  const auto share = [&] { return static_cast<double>(rng() >> 8) / static_cast<double>(1u << 24); };
  Keyframe keyframe;
  keyframe.T_map_kf = keyframe.T_odom_kf = believed;
  keyframe.travelled_m = travelled_m;
  for (const Patch& patch : world) {
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d noise = 0.02 * Eigen::Vector3d(share() - 0.5, share() - 0.5, share() - 0.5);
      const Eigen::Vector3d p = truth.inverse() * (patch.origin + share() * patch.u + share() * patch.v + noise);
      if (p.norm() < 12) keyframe.points.push_back(p.cast<float>());
    }
  }
  return keyframe;
}

// Three metres driven, 27 m elsewhere, then back at the start with `drift` in the way since.
struct Return {
  SGraph graph;
  std::vector<Eigen::Isometry3d> truth;
  std::vector<SpatialEdge> loops;     // found in all
  std::vector<size_t> found_by_step;  // so far
};
Return ComeBack(const std::vector<Patch>& world, const Eigen::Isometry3d& drift, const SpatialLoopOptions& options = {}) {
  Return out;
  SpatialLoops loops(options);
  for (int i = 0; i < 10; ++i) {
    const bool back = i >= 7;
    const Eigen::Isometry3d truth = back ? At(0.5 * (i - 7), 0.1, 0.2) : At(0.5 * i, 0, 0);
    out.truth.push_back(truth);
    out.graph.keyframes.push_back(Seen(world, truth, back ? truth * drift : truth, 0.5 * i + (back ? 27 : 0)));
    out.graph.keyframes.back().id = static_cast<uint32_t>(i);
    const std::vector<SpatialEdge> found = loops.Add(out.graph);
    out.loops.insert(out.loops.end(), found.begin(), found.end());
    out.found_by_step.push_back(out.loops.size());
  }
  return out;
}

Eigen::Isometry3d Drift(double x_m, double y_m, double yaw_rad) {
  return Eigen::Translation3d(x_m, y_m, 0) * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
}

TEST(SpatialLoops, CloseAtAPlaceSeenAgainOnceConfirmed) {
  const Return r = ComeBack(Room(), Drift(0.3, -0.2, 0.05));
  EXPECT_EQ(r.found_by_step[7], 0u) << "one keyframe alone is not believed";
  ASSERT_GE(r.loops.size(), 2u);
  for (const SpatialEdge& loop : r.loops) {
    const Eigen::Isometry3d off = Between(r.truth[loop.from], r.truth[loop.to]).inverse() * loop.T_from_to;
    EXPECT_LT(off.translation().norm(), 0.01);
    EXPECT_LT(RotationAngle(off), 0.1 * kDegree);
    EXPECT_LT(loop.covariance.trace(), 3 * 0.02 * 0.02);
  }
}

TEST(SpatialLoops, NothingCountsThatOdometryCouldNotBeOffBy) {
  const Eigen::Isometry3d far = Drift(2, 0, 0);
  SpatialLoopOptions options;
  options.max_distance_m = 4;
  EXPECT_TRUE(ComeBack(Room(), far, options).loops.empty()) << "seven sigma off: a look-alike";
  options.drift.sigma_m_per_m = 0.05;
  EXPECT_FALSE(ComeBack(Room(), far, options).loops.empty()) << "two sigma off";
}

TEST(SpatialLoops, SmoothCorridorClosesAcrossOnly) {
  const Return r = ComeBack(Corridor(), Drift(0.3, 0.2, 0));
  ASSERT_FALSE(r.loops.empty());
  for (const SpatialEdge& loop : r.loops) {
    const Eigen::Isometry3d off = Between(r.truth[loop.from], r.truth[loop.to]).inverse() * loop.T_from_to;
    EXPECT_LT(std::abs((r.truth[loop.to].linear() * off.translation()).y()), 0.01);
    const Eigen::Vector3d along = r.truth[loop.from].linear().transpose() * Eigen::Vector3d::UnitX();
    EXPECT_GT(along.dot(loop.covariance.bottomRightCorner<3, 3>() * along), 100) << "the corridor's length is not measured";
  }
  SGraph graph = r.graph;
  graph.loops = r.loops;
  const std::vector<Eigen::Isometry3d> solved = SolvePoseGraph(graph.keyframes, SpatialLoops({}).EdgesOf(graph));
  const Eigen::Vector3d before = graph.keyframes.back().T_map_kf.translation() - r.truth.back().translation();
  const Eigen::Vector3d after = solved.back().translation() - r.truth.back().translation();
  EXPECT_GT(std::abs(before.y()), 0.1);
  EXPECT_LT(std::abs(after.y()), 0.01);
  EXPECT_GT(std::abs(after.x()), 0.1) << "nothing says where along the corridor";
}

TEST(SpatialLoops, AFloorAndOneWallAreNoPlace) {
  const std::vector<Patch> corridor = Corridor();
  EXPECT_TRUE(ComeBack({corridor[2], corridor[3]}, Drift(0.1, 0.1, 0)).loops.empty());
}

TEST(PassesGate, TakesAsManyDegreesOfFreedomAsAreHeld) {
  const Matrix6d unit = 0.5 * Matrix6d::Identity();
  EXPECT_TRUE(PassesGate(Eigen::Isometry3d::Identity(), unit, Drift(4.0, 0, 0), unit, 6));
  EXPECT_FALSE(PassesGate(Eigen::Isometry3d::Identity(), unit, Drift(4.0, 0, 0), unit, 5));
  EXPECT_FALSE(PassesGate(Eigen::Isometry3d::Identity(), 0.01 * unit, Drift(3.0, 0, 0), 0.01 * unit, 6))
      << "three metres at ten centimetres";
}

// Twice around the house with a heading that drifts by two degrees a round.
struct Driven {
  Mapper mapper;
  double off_m = 0, off_rad = 0;  // of the newest keyframe in the one of the first round that is nearest
};
Driven DriveTwice(const MapperOptions& options) {
  test::SyntheticLidarOptions lidar_options;
  lidar_options.azimuths = 600;
  const test::SyntheticLidar lidar(test::MakeHouse(), lidar_options);
  const test::Drive drive = test::HouseDrive(2);
  Driven out{Mapper(options)};
  Eigen::Isometry3d last = drive.At(0), odom = last;
  for (double t = 0; t < drive.duration_s(); t += 0.3) {
    const Eigen::Isometry3d at = drive.At(t), step = last.inverse() * at;
    odom = odom * step * Eigen::AngleAxisd(2 * kDegree * step.translation().norm() / 21, Eigen::Vector3d::UnitZ());
    last = at;
    Scan scan = lidar.Sweep([&](double) { return at; }, t);
    scan.time_s.clear();
    out.mapper.AddScan(scan, odom);
  }
  out.mapper.Flush();
  const std::vector<Keyframe>& keyframes = out.mapper.graph().keyframes;
  const Keyframe& newest = keyframes.back();
  const Eigen::Isometry3d truth = drive.At(newest.stamp_s);
  double nearest_m = 1e9;
  for (const Keyframe& k : keyframes) {
    const Eigen::Isometry3d true_step = drive.At(k.stamp_s).inverse() * truth;
    if (newest.travelled_m - k.travelled_m < 20 || true_step.translation().norm() >= nearest_m) continue;
    nearest_m = true_step.translation().norm();
    const Eigen::Isometry3d off = true_step.inverse() * (k.T_map_kf.inverse() * newest.T_map_kf);
    out.off_m = off.translation().norm();
    out.off_rad = RotationAngle(off);
  }
  return out;
}

TEST(Mapper, ClosesTheLoopOfADriftingHeading) {
  MapperOptions open;
  open.loops.min_way_m = 1e6;
  const Driven drifted = DriveTwice(open), closed = DriveTwice({});
  EXPECT_GT(drifted.off_rad, 1.0 * kDegree);
  ASSERT_GE(closed.mapper.graph().loops.size(), 2u);
  EXPECT_LT(closed.off_m, 0.02);
  EXPECT_LT(closed.off_rad, 0.1 * kDegree);
  const auto walls = [](const Driven& d) {
    return std::count_if(d.mapper.graph().surfaces.begin(), d.mapper.graph().surfaces.end(),
                         [](const MapSurface& s) { return !s.observations.empty() && s.kind == SurfaceKind::kWall && s.length_m() > 1; });
  };
  EXPECT_LT(walls(closed), walls(drifted)) << "walls seen twice are one again";
}

}  // namespace
}  // namespace plumb::runtime
