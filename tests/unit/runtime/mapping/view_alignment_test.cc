#include "runtime/mapping/view_alignment.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <vector>

#include "runtime/odometry/motion_prediction.h"

namespace plumb::runtime {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Patch {
  Plane plane;               // map frame
  Eigen::Vector3d at, u, v;  // points at + a * u + b * v, -1 <= a, b <= 1
};

Patch MakePatch(const Eigen::Vector3d& n, const Eigen::Vector3d& at, const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  return {{n, -n.dot(at)}, at, u, v};
}

const Patch kFloor = MakePatch(Eigen::Vector3d::UnitZ(), {3, 0, -0.6}, {2, 0, 0}, {0, 2, 0});
const Patch kSouth = MakePatch(Eigen::Vector3d::UnitY(), {2, -2, 0.2}, {2, 0, 0}, {0, 0, 0.8});
const Patch kEast = MakePatch(-Eigen::Vector3d::UnitX(), {5, 0, 0.2}, {0, 2, 0}, {0, 0, 0.8});

PlaneStats SeenFrom(const Patch& patch, const Eigen::Isometry3d& T_map_kf, unsigned seed) {
  std::mt19937 rng(seed);
  const auto share = [&] { return 2 * static_cast<double>(rng() >> 8) / static_cast<double>(1u << 24) - 1; };
  PlaneStats stats;
  for (int i = 0; i < 4000; ++i) {
    const double a = share(), b = share(), noise_m = 0.03 * share();
    stats.Add(T_map_kf.inverse() * Eigen::Vector3d(patch.at + a * patch.u + b * patch.v + noise_m * patch.plane.n));
  }
  return stats;
}

// Two keyframes 0.3 m apart, the second believed to be off by `error`.
struct Views {
  SGraph graph;
  Eigen::Isometry3d T_0_1;  // truth
};
Views Make(const std::vector<Patch>& patches, const Eigen::Isometry3d& error) {
  const Eigen::Isometry3d first(Eigen::Translation3d(1, 0.5, 0) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  Views out;
  out.T_0_1 = Eigen::Translation3d(0.3, 0, 0) * Eigen::AngleAxisd(-1.0, Eigen::Vector3d::UnitZ());
  out.graph.keyframes.resize(2);
  out.graph.keyframes[0].T_map_kf = first;
  out.graph.keyframes[1].T_map_kf = first * out.T_0_1 * error;
  out.graph.surfaces.resize(patches.size());
  for (size_t i = 0; i < patches.size(); ++i) {
    MapSurface& surface = out.graph.surfaces[i];
    surface.plane = patches[i].plane;
    surface.observations = {{0, SeenFrom(patches[i], first, 1)}, {1, SeenFrom(patches[i], first * out.T_0_1, 2)}};
  }
  return out;
}

Eigen::Isometry3d Error() {
  return Eigen::Translation3d(0.015, -0.01, 0.02) * Eigen::AngleAxisd(0.5 * kDegree, Eigen::Vector3d(1, -2, 1).normalized());
}

TEST(AlignedPose, TakesOutMostOfWhatOdometryWasOffBy) {
  const Views views = Make({kFloor, kSouth, kEast}, Error());
  const Eigen::Isometry3d off = views.T_0_1.inverse() * AlignedPose(views.graph, 1, 0, {});
  EXPECT_LT(off.translation().norm(), 0.4 * Error().translation().norm());
  EXPECT_LT(RotationAngle(off), 0.4 * RotationAngle(Error()));
}

TEST(AlignedPose, LeavesOpenDirectionsAsTheyAre) {
  const Views views = Make({kFloor, kSouth}, Eigen::Isometry3d(Eigen::Translation3d(0, 0.03, 0)));
  const Eigen::Isometry3d T_0_map = views.graph.keyframes[0].T_map_kf.inverse();
  const Eigen::Isometry3d moved = AlignedPose(views.graph, 1, 0, {}), before = T_0_map * views.graph.keyframes[1].T_map_kf;
  const Eigen::Vector3d step = T_0_map.linear().transpose() * (moved.translation() - before.translation());
  EXPECT_NEAR(step.x(), 0, 0.001) << "along the only wall";
  EXPECT_GT(step.norm(), 0.01) << "across it";
}

TEST(AlignedPose, OneWrongPairHoldsNothing) {
  Patch cupboard = kEast;
  Views views = Make({kFloor, kSouth, kEast, kEast, kSouth}, Eigen::Isometry3d::Identity());
  cupboard.at.x() -= 0.1;
  views.graph.surfaces[3].observations[1].stats = SeenFrom(cupboard, views.graph.keyframes[1].T_map_kf, 3);
  const Eigen::Isometry3d off = views.T_0_1.inverse() * AlignedPose(views.graph, 1, 0, {});
  EXPECT_LT(off.translation().norm(), 0.01);
}

TEST(AlignedPose, WithNothingInCommonIsAsTheGraphHasIt) {
  const Views views = Make({}, Error());
  EXPECT_TRUE(AlignedPose(views.graph, 1, 0, {}).isApprox(views.T_0_1 * Error(), 1e-12));
}

}  // namespace
}  // namespace plumb::runtime
