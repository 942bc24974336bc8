#include "runtime/mapping/pose_graph.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <array>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

namespace plumb::runtime {
namespace {

constexpr double kStepLoss = 3.0, kLoopLoss = 2.0;  // in sigmas
constexpr double kLever_m = 5.0;                    // what a heading's error counts as, in choosing paths

struct EdgeResidual {
  Pose2 T_from_to;
  Eigen::Matrix3d weight;  // its square is the information
  template <class T>
  bool operator()(const T* a, const T* b, T* r) const {
    using std::cos;
    using std::sin;
    const T c = cos(a[2]), s = sin(a[2]), dx = b[0] - a[0], dy = b[1] - a[1];
    T turn = b[2] - a[2] - T(T_from_to.yaw_rad);
    turn = turn - T(2 * std::numbers::pi) * ceres::floor((turn + T(std::numbers::pi)) / T(2 * std::numbers::pi));
    const Eigen::Matrix<T, 3, 1> off(c * dx + s * dy - T(T_from_to.t_m.x()), c * dy - s * dx - T(T_from_to.t_m.y()), turn);
    Eigen::Map<Eigen::Matrix<T, 3, 1>> out(r);
    out = weight.cast<T>() * off;
    return true;
  }
};

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
    const EdgeResidual residual{edge.T_from_to, information.llt().matrixU()};
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<EdgeResidual, 3, 3, 3>(new EdgeResidual(residual)),
                             edge.loop ? static_cast<ceres::LossFunction*>(&loop_loss) : &step_loss, blocks[edge.from].data(),
                             blocks[edge.to].data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 1;
  options.max_num_iterations = 30;
  options.function_tolerance = 1e-5;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return poses;
  std::vector<Pose2> solved;
  solved.reserve(poses.size());
  for (const auto& block : blocks) solved.push_back({{block[0], block[1]}, WrapYaw(block[2])});
  return solved;
}

std::vector<Eigen::Matrix3d> RelativeCovariances(const std::vector<Pose2>& poses, std::span<const PoseEdge> edges, uint32_t source) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<std::vector<uint32_t>> edges_of(poses.size());
  for (uint32_t e = 0; e < edges.size(); ++e) {
    edges_of[edges[e].from].push_back(e);
    edges_of[edges[e].to].push_back(e);
  }
  std::vector<Eigen::Matrix3d> covariances(poses.size(), Eigen::Vector3d::Constant(kInfinity).asDiagonal());
  std::vector<double> costs(poses.size(), kInfinity);
  std::vector<bool> done(poses.size(), false);
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
      const PoseEdge& edge = edges[e];
      const bool forward = edge.from == at;
      const uint32_t next = forward ? edge.to : edge.from;
      const double cost = costs[at] + edge.covariance(0, 0) + edge.covariance(1, 1) + kLever_m * kLever_m * edge.covariance(2, 2);
      if (cost >= costs[next]) continue;
      costs[next] = cost;
      const Eigen::Matrix3d step = forward ? edge.covariance : InverseCovariance(edge.T_from_to, edge.covariance);
      covariances[next] = ComposedCovariance(Between(poses[source], poses[at]), covariances[at], Between(poses[at], poses[next]), step);
      open.emplace(cost, next);
    }
  }
  return covariances;
}

}  // namespace plumb::runtime
