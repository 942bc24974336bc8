#include "runtime/optimization/window_optimizer.h"

#include <algorithm>
#include <array>
#include <memory>

#include "runtime/optimization/ceres_blocks.h"
#include "runtime/optimization/joint_problem.h"
#include "runtime/optimization/odometry_step.h"
#include "runtime/optimization/residuals.h"
#include "runtime/optimization/wall_measurement.h"

namespace plumb::runtime {
namespace {

constexpr int kMaxIterations = 10;

class Window {
 public:
  Window(const SGraph& map, size_t first, const JointOptions& options)
      : map_(map), first_(first), options_(options), observation_loss_(options.observation_loss), odometry_loss_(kOdometryLoss),
        map_pose_(PoseBlock(Eigen::Isometry3d::Identity())), problem_(SharedLossesAndManifolds()) {
    for (size_t i = first; i < map.keyframes.size(); ++i) poses_.push_back(PoseBlock(map.keyframes[i].T_map_kf));
    planes_.reserve(map.surfaces.size());
    AddOdometry();
    for (const MapSurface& surface : map.surfaces) AddSurface(surface);
  }

  [[nodiscard]] std::vector<Eigen::Isometry3d> Solve() {
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    solver.num_threads = 1;  // summation order, hence the result, must not depend on scheduling
    solver.max_num_iterations = kMaxIterations;
    solver.function_tolerance = 1e-6;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem_, &summary);
    std::vector<Eigen::Isometry3d> out;
    if (!summary.IsSolutionUsable()) return out;
    for (const auto& pose : poses_) out.push_back(PoseOf(pose));
    return out;
  }

 private:
  void AddOdometry() {
    size_t before = first_;
    while (before > 0 && (before == first_ || map_.keyframes[before].merged)) --before;
    before_pose_ = PoseBlock(map_.keyframes[before].T_map_kf);
    problem_.AddParameterBlock(before_pose_.data(), kPoseSize, &pose_manifold_);
    problem_.SetParameterBlockConstant(before_pose_.data());
    double* last_pose = before_pose_.data();
    for (size_t i = 0; i < poses_.size(); ++i) {
      problem_.AddParameterBlock(poses_[i].data(), kPoseSize, &pose_manifold_);
      const Keyframe& last = map_.keyframes[i == 0 ? before : first_ + i - 1];
      problem_.AddResidualBlock(Cost<OdometryResidual, 6, kPoseSize, kPoseSize>(OdometryStep(last, map_.keyframes[first_ + i], options_)),
                                &odometry_loss_, last_pose, poses_[i].data());
      last_pose = poses_[i].data();
    }
  }

  void AddSurface(const MapSurface& surface) {
    const std::vector<Observation>& observations = surface.observations;
    if (observations.size() < 2 || observations.back().keyframe < first_) return;
    const Eigen::Vector3d n = surface.plane.n.normalized();
    double* plane = planes_.emplace_back(std::array<double, kPlaneSize>{n.x(), n.y(), n.z(), surface.plane.d}).data();
    problem_.AddParameterBlock(plane, kPlaneSize, &plane_manifold_);
    problem_.AddResidualBlock(Cost<PriorResidual<kPlaneSize>, kPlaneSize, kPlaneSize>({planes_.back(), &kPlaneWeight}), nullptr, plane);
    PlaneStats earlier;
    size_t num_earlier = 0;
    for (const Observation& o : observations) {
      if (o.keyframe >= first_) {
        AddView({PlaneView(o.stats, NoiseOf(options_, map_.keyframes[o.keyframe]), observations.size())}, &observation_loss_,
                poses_[o.keyframe - first_].data(), plane);
        continue;
      }
      earlier.Add(o.stats.Transformed(map_.keyframes[o.keyframe].T_map_kf));
      ++num_earlier;
    }
    if (num_earlier == 0) return;
    // As good as that many views.
    earlier_losses_.push_back(std::make_unique<ceres::ScaledLoss>(nullptr, static_cast<double>(num_earlier), ceres::DO_NOT_TAKE_OWNERSHIP));
    AddView({PlaneView(earlier, NoiseOf(options_), observations.size())}, earlier_losses_.back().get(), map_pose_.data(), plane);
    if (earlier_losses_.size() > 1) return;
    problem_.SetManifold(map_pose_.data(), &pose_manifold_);
    problem_.SetParameterBlockConstant(map_pose_.data());
  }

  void AddView(const FreeViewResidual& residual, ceres::LossFunction* loss, double* pose, double* plane) {
    problem_.AddResidualBlock(Cost<FreeViewResidual, 3, kPoseSize, kPlaneSize>(residual), loss, pose, plane);
  }

  const SGraph& map_;
  const size_t first_;
  const JointOptions& options_;
  ceres::CauchyLoss observation_loss_;
  ceres::HuberLoss odometry_loss_;
  std::vector<std::unique_ptr<ceres::ScaledLoss>> earlier_losses_;
  PoseManifold pose_manifold_;
  PlaneManifold plane_manifold_;
  std::array<double, kPoseSize> map_pose_, before_pose_{};
  std::vector<std::array<double, kPoseSize>> poses_;
  std::vector<std::array<double, kPlaneSize>> planes_;
  ceres::Problem problem_;  // last: it points at all of the above
};

}  // namespace

std::vector<Eigen::Isometry3d> OptimizeWindow(const SGraph& map, size_t count, const JointOptions& options) {
  if (count == 0 || map.keyframes.size() <= count) return {};
  const size_t first = map.keyframes.size() - count;
  const bool any_merged = std::any_of(map.keyframes.begin() + static_cast<std::ptrdiff_t>(first), map.keyframes.end(),
                                      [](const Keyframe& k) { return k.merged.has_value(); });
  if (any_merged) return {};
  return Window(map, first, options).Solve();
}

}  // namespace plumb::runtime
