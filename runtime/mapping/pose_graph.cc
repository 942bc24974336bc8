#include "runtime/mapping/pose_graph.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <array>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace plumb::runtime {
namespace {

constexpr double kStepLoss = 3.0, kLoopLoss = 2.0;  // in sigmas
constexpr double kLever_m = 5.0;                    // what a heading's error counts as, in choosing paths

double PathCost(const Eigen::Matrix3d& c) { return c(0, 0) + c(1, 1) + kLever_m * kLever_m * c(2, 2); }
double PathCost(const Matrix6d& c) { return c.bottomRightCorner<3, 3>().trace() + kLever_m * kLever_m * c.topLeftCorner<3, 3>().trace(); }

// See RelativeCovariances(). `poses`: a function of the index.
template <int N, class Poses, class Edge>
std::vector<Eigen::Matrix<double, N, N>> AlongSurestPaths(size_t num_poses, const Poses& poses, std::span<const Edge> edges,
                                                          uint32_t source) {
  using Covariance = Eigen::Matrix<double, N, N>;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<std::vector<uint32_t>> edges_of(num_poses);
  for (uint32_t e = 0; e < edges.size(); ++e) {
    edges_of[edges[e].from].push_back(e);
    edges_of[edges[e].to].push_back(e);
  }
  std::vector<Covariance> covariances(num_poses, Covariance(Eigen::Matrix<double, N, 1>::Constant(kInfinity).asDiagonal()));
  std::vector<double> costs(num_poses, kInfinity);
  std::vector<bool> done(num_poses, false);
  using Entry = std::pair<double, uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  covariances[source].setZero();
  costs[source] = 0;
  open.emplace(0.0, source);
  while (!open.empty()) {
    const uint32_t at = open.top().second;
    open.pop();
    if (done[at]) continue;
    done[at] = true;
    for (const uint32_t e : edges_of[at]) {
      const Edge& edge = edges[e];
      const bool forward = edge.from == at;
      const uint32_t next = forward ? edge.to : edge.from;
      const double cost = costs[at] + PathCost(edge.covariance);
      if (cost >= costs[next]) continue;
      costs[next] = cost;
      const Covariance step = forward ? edge.covariance : InverseCovariance(edge.T_from_to, edge.covariance);
      covariances[next] = ComposedCovariance(Between(poses(source), poses(at)), covariances[at], Between(poses(at), poses(next)), step);
      open.emplace(cost, next);
    }
  }
  return covariances;
}

using PoseBlock = std::array<double, 7>;

PoseBlock BlockOf(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d& t = T.translation();
  return {q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}

Eigen::Isometry3d PoseOf(const PoseBlock& b) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(b[3], b[0], b[1], b[2]).normalized().toRotationMatrix();
  T.translation() << b[4], b[5], b[6];
  return T;
}

bool Solve(ceres::Problem* problem) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 1;
  options.max_num_iterations = 30;
  options.function_tolerance = 1e-5;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem, &summary);
  return summary.IsSolutionUsable();
}

}  // namespace

std::vector<Pose2> SolvePoseGraph(const std::vector<Pose2>& poses, std::span<const PoseEdge> edges) {
  if (edges.empty()) return poses;
  std::vector<std::array<double, 3>> blocks;
  blocks.reserve(poses.size());
  for (const Pose2& pose : poses) blocks.push_back({pose.t_m.x(), pose.t_m.y(), pose.yaw_rad});
  ceres::HuberLoss step_loss(kStepLoss);
  ceres::CauchyLoss loop_loss(kLoopLoss);
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (auto& block : blocks) problem.AddParameterBlock(block.data(), 3);
  problem.SetParameterBlockConstant(blocks.front().data());
  for (const PoseEdge& edge : edges) {
    const Eigen::Matrix3d information = edge.covariance.ldlt().solve(Eigen::Matrix3d::Identity());
    const PlanarMotionResidual residual{edge.T_from_to, information.llt().matrixU()};
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PlanarMotionResidual, 3, 3, 3>(new PlanarMotionResidual(residual)),
                             edge.loop ? static_cast<ceres::LossFunction*>(&loop_loss) : &step_loss, blocks[edge.from].data(),
                             blocks[edge.to].data());
  }
  if (!Solve(&problem)) return poses;
  std::vector<Pose2> solved;
  solved.reserve(poses.size());
  for (const auto& block : blocks) solved.push_back({{block[0], block[1]}, WrapYaw(block[2])});
  return solved;
}

std::vector<Eigen::Matrix3d> RelativeCovariances(const std::vector<Pose2>& poses, std::span<const PoseEdge> edges, uint32_t source) {
  return AlongSurestPaths<3>(poses.size(), [&](uint32_t i) -> const Pose2& { return poses[i]; }, edges, source);
}

std::vector<Matrix6d> RelativeCovariances(const std::vector<Keyframe>& keyframes, std::span<const SpatialEdge> edges, uint32_t source) {
  const auto pose = [&](uint32_t i) -> const Eigen::Isometry3d& { return keyframes[i].T_map_kf; };
  return AlongSurestPaths<6>(keyframes.size(), pose, edges, source);
}

MotionResidual ResidualOf(const SpatialEdge& edge, const std::vector<Keyframe>& keyframes) {
  const auto carried = [&](uint32_t i) { return keyframes[i].merged ? keyframes[i].merged->T_into_kf : Eigen::Isometry3d::Identity(); };
  const Matrix6d information = edge.covariance.ldlt().solve(Matrix6d::Identity());
  return {edge.T_from_to, information.llt().matrixU(), carried(edge.from), carried(edge.to)};
}

std::vector<Eigen::Isometry3d> SolvePoseGraph(const std::vector<Keyframe>& keyframes, std::span<const SpatialEdge> edges) {
  std::vector<Eigen::Isometry3d> solved;
  std::vector<PoseBlock> blocks;
  for (const Keyframe& keyframe : keyframes) {
    solved.push_back(keyframe.T_map_kf);
    blocks.push_back(BlockOf(keyframe.T_map_kf));
  }
  ceres::HuberLoss step_loss(kStepLoss);
  ceres::CauchyLoss loop_loss(kLoopLoss);
  ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>> manifold;
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (size_t i = 0; i < keyframes.size(); ++i) {
    if (!keyframes[i].merged) problem.AddParameterBlock(blocks[i].data(), 7, &manifold);
  }
  if (problem.NumParameterBlocks() == 0) return solved;
  problem.SetParameterBlockConstant(blocks[RootOf(keyframes.front())].data());
  for (const SpatialEdge& edge : edges) {
    const uint32_t from = RootOf(keyframes[edge.from]), to = RootOf(keyframes[edge.to]);
    if (from == to) continue;
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<MotionResidual, 6, 7, 7>(new MotionResidual(ResidualOf(edge, keyframes))),
                             edge.loop ? static_cast<ceres::LossFunction*>(&loop_loss) : &step_loss, blocks[from].data(),
                             blocks[to].data());
  }
  if (!Solve(&problem)) return solved;
  for (size_t i = 0; i < keyframes.size(); ++i) {
    const Keyframe& k = keyframes[i];
    solved[i] = k.merged ? PoseOf(blocks[k.merged->into]) * k.merged->T_into_kf : PoseOf(blocks[i]);
  }
  return solved;
}

}  // namespace plumb::runtime
