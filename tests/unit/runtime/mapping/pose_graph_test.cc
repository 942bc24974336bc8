#include "runtime/mapping/pose_graph.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumb::runtime {
namespace {

Eigen::Matrix3d Diagonal(double at_m, double at_rad) { return Eigen::Vector3d(at_m * at_m, at_m * at_m, at_rad * at_rad).asDiagonal(); }

// A square of 4 x 10 steps of a metre, true and as odometry that turns too far has it.
struct Square {
  std::vector<Pose2> truth, drifted;
  std::vector<PoseEdge> edges;
};
Square MakeSquare() {
  Square square;
  square.truth.emplace_back();
  square.drifted.emplace_back();
  for (uint32_t i = 1; i <= 40; ++i) {
    const double turn_rad = i % 10 == 0 ? std::numbers::pi / 2 : 0;
    square.truth.push_back(square.truth.back() * Pose2{{1, 0}, turn_rad});
    const Pose2 step{{1, 0}, turn_rad + 0.002};
    square.drifted.push_back(square.drifted.back() * step);
    square.edges.push_back({i - 1, i, step, Diagonal(0.02, 0.005), false});
  }
  return square;
}

TEST(PoseGraph, ALoopTakesOutTheDrift) {
  Square square = MakeSquare();
  EXPECT_GT((square.drifted[40].t_m - square.truth[40].t_m).norm(), 0.3);
  square.edges.push_back({0, 40, Between(square.truth[0], square.truth[40]), Diagonal(0.01, 0.002), true});
  const std::vector<Pose2> solved = SolvePoseGraph(square.drifted, square.edges);
  EXPECT_EQ(solved[0].t_m, square.drifted[0].t_m);
  EXPECT_LT((solved[40].t_m - square.truth[40].t_m).norm(), 0.05);
  for (size_t i = 0; i < solved.size(); ++i) EXPECT_LT((solved[i].t_m - square.truth[i].t_m).norm(), 0.25);
}

TEST(PoseGraph, LetsGoOfAWrongLoop) {
  Square square = MakeSquare();
  square.edges.push_back({0, 40, Between(square.truth[0], square.truth[40]), Diagonal(0.01, 0.002), true});
  square.edges.push_back({1, 39, Between(square.truth[1], square.truth[39]), Diagonal(0.01, 0.002), true});
  square.edges.push_back({10, 30, {{0.0, 0.5}, 0}, Diagonal(0.01, 0.002), true});  // 14 m off
  const std::vector<Pose2> solved = SolvePoseGraph(square.drifted, square.edges);
  for (size_t i = 0; i < solved.size(); ++i) EXPECT_LT((solved[i].t_m - square.truth[i].t_m).norm(), 0.4) << i;
}

TEST(PoseGraph, HeadingsWrapAround) {
  const std::vector<Pose2> poses = {{{0, 0}, 3.1}, {{-1, 0}, -3.1}};
  const std::vector<PoseEdge> edges = {{0, 1, Between(poses[0], poses[1]), Diagonal(0.1, 0.1), false}};
  const std::vector<Pose2> solved = SolvePoseGraph(poses, edges);
  EXPECT_LT((solved[1].t_m - poses[1].t_m).norm(), 1e-6);
  EXPECT_NEAR(WrapYaw(solved[1].yaw_rad - poses[1].yaw_rad), 0, 1e-6);
}

TEST(RelativeCovariances, GrowAlongTheWayAndShrinkWithALoop) {
  Square square = MakeSquare();
  const std::vector<Eigen::Matrix3d> open = RelativeCovariances(square.truth, square.edges, 40);
  EXPECT_EQ(open[40].norm(), 0);
  EXPECT_NEAR(open[39](2, 2), 0.005 * 0.005, 1e-12);
  EXPECT_NEAR(open[0](2, 2), 40 * 0.005 * 0.005, 1e-10);
  // From 30 to 40: ten steps of 2 cm, and headings 5 mrad each whose levers are 1 to 10 m.
  const double variance_m2 = open[30](0, 0) + open[30](1, 1);
  EXPECT_NEAR(variance_m2, 2 * 10 * 0.02 * 0.02 + 385 * 0.005 * 0.005, 1e-4);
  square.edges.push_back({0, 40, Between(square.truth[0], square.truth[40]), Diagonal(0.01, 0.002), true});
  const std::vector<Eigen::Matrix3d> closed = RelativeCovariances(square.truth, square.edges, 40);
  EXPECT_NEAR(closed[0](2, 2), 0.002 * 0.002, 1e-12);
  EXPECT_LT(closed[5].trace(), 0.2 * open[5].trace());
}

TEST(RelativeCovariances, AreInfiniteWhereNoPathLeads) {
  const std::vector<Pose2> poses(3);
  const std::vector<PoseEdge> edges = {{0, 1, {}, Diagonal(0.1, 0.1), false}};
  const std::vector<Eigen::Matrix3d> covariances = RelativeCovariances(poses, edges, 0);
  EXPECT_TRUE(std::isinf(covariances[2](0, 0)));
}

TEST(SpatialPoseGraph, CovarianceGrowsAlongTheChainAndALoopEndsIt) {
  std::vector<Keyframe> keyframes(11);
  std::vector<SpatialEdge> edges;
  for (uint32_t i = 0; i < keyframes.size(); ++i) {
    keyframes[i].id = i;
    keyframes[i].T_map_kf.translation().x() = i;
    if (i > 0) edges.push_back({i - 1, i, Between(keyframes[i - 1].T_map_kf, keyframes[i].T_map_kf), 1e-4 * Matrix6d::Identity(), false});
  }
  const std::vector<Matrix6d> open = RelativeCovariances(keyframes, edges, 0);
  for (int i = 1; i < 11; ++i) {
    EXPECT_NEAR(open[i](2, 2), i * 1e-4, 1e-12);
    EXPECT_NEAR(open[i](3, 3), i * 1e-4, 1e-12);
    double across = 0;  // every step's heading moves the end by its lever
    for (int k = 1; k <= i; ++k) across += 1e-4 * (1 + (i - k) * (i - k));
    EXPECT_NEAR(open[i](4, 4), across, 1e-12);
  }
  edges.push_back({0, 10, keyframes[10].T_map_kf, 1e-4 * Matrix6d::Identity(), true});
  EXPECT_NEAR(RelativeCovariances(keyframes, edges, 0)[10](4, 4), 1e-4, 1e-12);
}

TEST(SpatialPoseGraph, MergedKeyframesGoWhereTheirRootGoes) {
  std::vector<Keyframe> keyframes(3);
  for (uint32_t i = 0; i < 3; ++i) {
    keyframes[i].id = i;
    keyframes[i].T_map_kf = Eigen::Translation3d(i, 0, 0) * Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ());
  }
  keyframes[2].merged = Keyframe::Merged{1, Between(keyframes[1].T_map_kf, keyframes[2].T_map_kf)};
  const Eigen::Isometry3d T_0_2 = Eigen::Translation3d(0, 0.5, 0) * keyframes[2].T_map_kf;
  const std::vector<SpatialEdge> edges = {{0, 2, T_0_2, 1e-4 * Matrix6d::Identity(), false}};
  const std::vector<Eigen::Isometry3d> solved = SolvePoseGraph(keyframes, edges);
  EXPECT_TRUE(solved[2].isApprox(T_0_2, 1e-6));
  EXPECT_TRUE((solved[1] * keyframes[2].merged->T_into_kf).isApprox(solved[2], 1e-9));
}

}  // namespace
}  // namespace plumb::runtime
