#include "runtime/optimization/joint_problem.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "runtime/mapping/pose_graph.h"
#include "runtime/odometry/planar/planar_scan.h"
#include "runtime/optimization/ceres_blocks.h"
#include "runtime/optimization/level_pose_manifold.h"
#include "runtime/optimization/level_votes.h"
#include "runtime/optimization/odometry_step.h"
#include "runtime/optimization/wall_measurement.h"

namespace plumb::runtime {
namespace {

constexpr double kAnchorSigma_m = 1e-4, kAnchorSigma_rad = 1e-4;
// Far weaker than any observation: they only keep the problem regular where nothing was observed (a corridor, no floor, a line of points).
constexpr std::array<double, kPlaceSize> kPlaceWeight{0.1, 0.1, 0.1, 1.0};
constexpr double kHeldHeight_m = 0.005;  // without floor or ceiling, walls a thousandth off plumb would drag the height along by metres
constexpr double kLoopLoss = 2.0;        // in sigmas

}  // namespace

struct JointProblem::Impl {
  Impl(const SGraph& map_in, const AGraph& plan_in, const std::vector<WallFrame>& frames_in, const JointOptions& options_in,
       JointState& state_in)
      : map(map_in),
        plan(plan_in),
        frames(frames_in),
        options(options_in),
        state(state_in),
        observation_loss(options.observation_loss),
        odometry_loss(kOdometryLoss),
        loop_loss(kLoopLoss),
        floor_loss(kFloorLoss),
        ceiling_loss(kCeilingLoss),
        level_weight{1 / options.level_sigma_m},
        bias_weight{1 / options.bias_sigma_m},
        problem(SharedLossesAndManifolds()) {}

  void AddKeyframes() {
    ceres::Manifold* const manifold = map.planar ? static_cast<ceres::Manifold*>(&level_pose_manifold) : &pose_manifold;
    for (size_t i = 0; i < map.keyframes.size(); ++i) {
      if (!map.keyframes[i].merged) problem.AddParameterBlock(state.poses[i].data(), kPoseSize, manifold);
    }
    problem.AddResidualBlock(Cost<AnchorResidual, 6, kPoseSize>({Anchor(), kAnchorSigma_m, kAnchorSigma_rad, options.gravity_sigma_rad}),
                             nullptr, state.poses[0].data());
    if (map.planar) return AddEdges();
    for (size_t i = 1, last = 0; i < map.keyframes.size(); ++i) {
      if (map.keyframes[i].merged) continue;
      problem.AddResidualBlock(
          Cost<OdometryResidual, 6, kPoseSize, kPoseSize>(OdometryStep(map.keyframes[last], map.keyframes[i], options)), &odometry_loss,
          state.poses[last].data(), state.poses[i].data());
      last = i;
    }
    AddLoops();
  }

  void AddLoops() {
    for (const SpatialEdge& loop : map.loops) {
      const uint32_t from = RootOf(map.keyframes[loop.from]), to = RootOf(map.keyframes[loop.to]);
      if (from == to) continue;
      problem.AddResidualBlock(Cost<MotionResidual, 6, kPoseSize, kPoseSize>(ResidualOf(loop, map.keyframes)), &loop_loss,
                               state.poses[from].data(), state.poses[to].data());
    }
  }

  // What odometry and loops say of a planar laser's motion, each with its own covariance.
  void AddEdges() {
    const auto unlevel = [&](uint32_t keyframe) {
      return Eigen::Quaterniond(Leveled(map.keyframes[keyframe].T_map_kf).leveling).conjugate();
    };
    for (const PoseEdge& edge : map.edges) {
      const Eigen::Matrix3d sqrt_information = edge.covariance.inverse().llt().matrixU();
      problem.AddResidualBlock(
          Cost<LevelStepResidual, 3, kPoseSize, kPoseSize>({edge.T_from_to, sqrt_information, unlevel(edge.from), unlevel(edge.to)}),
          edge.loop ? static_cast<ceres::LossFunction*>(&loop_loss) : &odometry_loss, state.poses[edge.from].data(),
          state.poses[edge.to].data());
    }
  }

  // Where the first keyframe is, but upright as odometry measured it: of the present estimate, gravity would be a prior that follows the
  // data.
  [[nodiscard]] Eigen::Isometry3d Anchor() const {
    Eigen::Isometry3d T = PoseOf(state.poses[0]);
    const Eigen::Matrix3d& R_odom = map.keyframes[0].T_odom_kf.linear();
    const Eigen::Matrix3d turn = T.linear() * R_odom.transpose();
    T.linear() = Eigen::AngleAxisd(std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1)), Eigen::Vector3d::UnitZ()) * R_odom;
    return T;
  }

  void AddPlaceAndBias(const std::vector<Match>& matches) {
    const bool has_level = std::any_of(matches.begin(), matches.end(), [](const Match& m) { return !m.plan_surface.valid(); });
    if (!has_level) place_weight[2] = 1 / kHeldHeight_m;
    problem.AddResidualBlock(Cost<PriorResidual<kPlaceSize>, kPlaceSize, kPlaceSize>({state.place, &place_weight}), nullptr,
                             state.place.data());
    problem.AddResidualBlock(Cost<PriorResidual<1>, 1, 1>({{0.0}, &bias_weight}), nullptr, &state.bias_m);
  }

  void AddWalls(const std::vector<Match>& matches) {
    const bool held = ScheduleOf(options.mode).prior == EstimationSchedule::WallPrior::kHeld;
    wall_weights.assign(state.walls.size(), {0, 0, 1 / options.tilt_sigma_rad, 1 / options.thickness_sigma_m});
    for (size_t w = 0; w < state.walls.size(); ++w) {
      problem.AddResidualBlock(Cost<PriorResidual<kNumWallParameters>, kNumWallParameters, kNumWallParameters>({{}, &wall_weights[w]}),
                               nullptr, state.walls[w].data());
      if (held) problem.SetParameterBlockConstant(state.walls[w].data());
    }
    for (const Match& m : matches) {
      if (!m.plan_surface.valid()) continue;
      const Surface& surface = plan.surfaces[m.plan_surface.index()];
      const auto at = std::lower_bound(state.wall_ids.begin(), state.wall_ids.end(), surface.wall);
      double* wall = state.walls[static_cast<size_t>(at - state.wall_ids.begin())].data();
      const Face face = MakeFace(frames[surface.wall.index()], surface);
      const std::vector<Observation>& observations = map.surfaces[m.map_surface].observations;
      for (size_t i = 0; i < observations.size(); ++i) {
        const Observation& o = observations[i];
        if (m.IsMistaken(i)) continue;
        problem.AddResidualBlock(Cost<WallViewResidual, 3, kPoseSize, kPlaceSize, kNumWallParameters, 1>(
                                     {PlaneView(o.stats, NoiseOf(options, map.keyframes[o.keyframe], m), observations.size()), face}),
                                 held ? nullptr : &observation_loss, state.poses[o.keyframe].data(), state.place.data(), wall,
                                 &state.bias_m);
      }
    }
  }

  void AddLevels(const std::vector<Match>& matches) {
    const std::vector<LevelVote> votes = LevelVotes(map, plan, matches, Poses(state), PlaceOf(state.place));
    state.levels.clear();
    state.levels.reserve(votes.size());
    for (const LevelVote& vote : votes) {
      // From where it stands: from zero, the ceilings of a building lower than planned would together push the floor down.
      double* level = state.levels.emplace_back(std::array<double, 1>{vote.error_m}).data();
      level_losses.push_back(
          std::make_unique<ceres::ScaledLoss>(vote.floor ? &floor_loss : &ceiling_loss, vote.share, ceres::DO_NOT_TAKE_OWNERSHIP));
      problem.AddResidualBlock(Cost<PriorResidual<1>, 1, 1>({{0.0}, &level_weight}), level_losses.back().get(), level);
      const std::vector<Observation>& observations = map.surfaces[matches[vote.match].map_surface].observations;
      for (const Observation& o : observations) {
        const LevelViewResidual residual{PlaneView(o.stats, NoiseOf(options, map.keyframes[o.keyframe]), observations.size()),
                                         vote.planned_z_m, vote.floor ? 1.0 : -1.0};
        problem.AddResidualBlock(Cost<LevelViewResidual, 3, kPoseSize, kPlaceSize, 1>(residual), &observation_loss,
                                 state.poses[o.keyframe].data(), state.place.data(), level);
      }
    }
  }

  void AddFreePlanes(const std::vector<Match>& matches) {
    std::vector<bool> matched(map.surfaces.size(), false);
    for (const Match& m : matches) matched[m.map_surface] = true;
    state.planes.clear();
    state.planes.reserve(map.surfaces.size());
    for (size_t i = 0; i < map.surfaces.size(); ++i) {
      const MapSurface& surface = map.surfaces[i];
      if (matched[i] || surface.observations.size() < 2) continue;
      const Eigen::Vector3d n = surface.plane.n.normalized();
      double* plane = state.planes.emplace_back(std::array<double, kPlaneSize>{n.x(), n.y(), n.z(), surface.plane.d}).data();
      problem.AddParameterBlock(plane, kPlaneSize, &plane_manifold);
      problem.AddResidualBlock(Cost<PriorResidual<kPlaneSize>, kPlaneSize, kPlaneSize>({state.planes.back(), &kPlaneWeight}), nullptr,
                               plane);
      for (const Observation& o : surface.observations) {
        problem.AddResidualBlock(Cost<FreeViewResidual, 3, kPoseSize, kPlaneSize>(
                                     {PlaneView(o.stats, NoiseOf(options, map.keyframes[o.keyframe]), surface.observations.size())}),
                                 &observation_loss, state.poses[o.keyframe].data(), plane);
      }
    }
  }

  const SGraph& map;
  const AGraph& plan;
  const std::vector<WallFrame>& frames;
  const JointOptions& options;
  JointState& state;
  ceres::CauchyLoss observation_loss;
  ceres::HuberLoss odometry_loss;
  ceres::CauchyLoss loop_loss;
  ceres::CauchyLoss floor_loss, ceiling_loss;
  std::vector<std::unique_ptr<ceres::LossFunction>> level_losses;
  PoseManifold pose_manifold;
  LevelPoseManifold level_pose_manifold;
  PlaneManifold plane_manifold;
  std::vector<std::array<double, kNumWallParameters>> wall_weights;
  std::array<double, 1> level_weight, bias_weight;
  std::array<double, kPlaceSize> place_weight = kPlaceWeight;
  ceres::Problem problem;  // last: it points at all of the above
};

Eigen::Isometry3d PoseOf(const std::array<double, kPoseSize>& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Map<const Eigen::Quaterniond>(pose.data()).normalized().toRotationMatrix();
  T.translation() = Eigen::Map<const Eigen::Vector3d>(pose.data() + 4);
  return T;
}

std::array<double, kPoseSize> PoseBlock(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(T.linear()).normalized();
  const Eigen::Vector3d t = T.translation();
  return {q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}

Eigen::Isometry3d PlaceOf(const std::array<double, kPlaceSize>& place) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(place[3], Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(place[0], place[1], place[2]);
  return T;
}

std::vector<Eigen::Isometry3d> Poses(const JointState& state) {
  std::vector<Eigen::Isometry3d> poses;
  poses.reserve(state.poses.size());
  for (const auto& pose : state.poses) poses.push_back(PoseOf(pose));
  return poses;
}

std::array<double, kPlaceSize> PlaceBlock(const Eigen::Isometry3d& T_plan_map) {
  const Eigen::Vector3d t = T_plan_map.translation();
  return {t.x(), t.y(), t.z(), std::atan2(T_plan_map.linear()(1, 0), T_plan_map.linear()(0, 0))};
}

JointProblem::JointProblem(const SGraph& map, const AGraph& plan, const std::vector<WallFrame>& frames, const std::vector<Match>& matches,
                           const JointOptions& options, JointState& state)
    : impl_(std::make_unique<Impl>(map, plan, frames, options, state)) {
  impl_->AddKeyframes();
  impl_->AddPlaceAndBias(matches);
  impl_->AddWalls(matches);
  impl_->AddLevels(matches);
  impl_->AddFreePlanes(matches);
}

JointProblem::~JointProblem() = default;

void JointProblem::SetWallPrior(size_t wall, const Eigen::Vector2d& information) {
  impl_->wall_weights[wall][kWallOffset] = std::sqrt(information.x());
  impl_->wall_weights[wall][kWallYaw] = std::sqrt(information.y());
}

JointProblem::Outcome JointProblem::Solve() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 1;  // summation order, hence the result, must not depend on scheduling
  options.max_num_iterations = impl_->options.max_iterations;
  options.function_tolerance = 1e-7;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &impl_->problem, &summary);
  return {summary.IsSolutionUsable(), summary.termination_type == ceres::CONVERGENCE,
          summary.num_successful_steps + summary.num_unsuccessful_steps, summary.final_cost, summary.message};
}

std::optional<JointCovariances> JointProblem::Covariances() const {
  ceres::Covariance::Options options;
  options.num_threads = 1;
  ceres::Covariance covariance(options);
  const JointState& state = impl_->state;
  std::vector<std::pair<const double*, const double*>> blocks{{state.place.data(), state.place.data()}};
  for (const auto& wall : state.walls) blocks.emplace_back(wall.data(), wall.data());
  if (!covariance.Compute(blocks, &impl_->problem)) return std::nullopt;

  const auto get = [&](const double* block) {
    Eigen::Matrix<double, 4, 4, Eigen::RowMajor> m;
    covariance.GetCovarianceBlock(block, block, m.data());
    return Eigen::Matrix4d(0.5 * (m + m.transpose()));
  };
  JointCovariances out;
  out.place = get(state.place.data());
  for (const auto& wall : state.walls) out.walls.push_back(get(wall.data()));
  return out;
}

}  // namespace plumb::runtime
