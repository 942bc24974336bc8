#include "runtime/optimization/joint_optimizer.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include "runtime/coupling/mixture.h"
#include "runtime/optimization/built_tolerance.h"
#include "runtime/optimization/joint_problem.h"
#include "runtime/optimization/level_votes.h"
#include "runtime/optimization/patch_agreement.h"
#include "runtime/optimization/place_seed.h"
#include "runtime/optimization/seen_walls.h"
#include "runtime/optimization/wall_measurement.h"

namespace plumb::runtime {
namespace {

constexpr double kSettled = 0.01;      // priors that change less end the EM rounds
constexpr double kNoThickness = 1e-3;  // of its prior: as good as none

std::string CheckInput(const SGraph& map, const AGraph& plan, const std::vector<WallFrame>& frames, const std::vector<Match>& matches,
                       const JointOptions& options) {
  if (std::string error = options.Check(); !error.empty()) return error;
  if (map.keyframes.empty()) return "the map has no keyframes";
  for (const Match& m : matches) {
    if (m.map_surface >= map.surfaces.size())
      return fmt::format("match of map surface {}; the map has {}", m.map_surface, map.surfaces.size());
    if (!m.plan_surface.valid()) {
      if (!m.room.valid() || m.room.index() >= plan.rooms.size())
        return fmt::format("match of map surface {} has neither plan surface nor room", m.map_surface);
      continue;
    }
    if (m.plan_surface.index() >= plan.surfaces.size())
      return fmt::format("match with plan surface {}; the plan has {}", m.plan_surface.value, plan.surfaces.size());
    const Surface& surface = plan.surfaces[m.plan_surface.index()];
    if (!surface.wall.valid() || !IsFace(frames[surface.wall.index()], surface)) {
      return fmt::format("match with plan surface {}, which is no face of a wall", m.plan_surface.value);
    }
  }
  return {};
}

const char* GaugeRule(EstimationMode mode) {
  switch (mode) {
    case EstimationMode::kDis: break;
    case EstimationMode::kIs:
      return "The plan is laid where all seen walls together fit it best, and no deviations are estimated (mode is)";
    case EstimationMode::kUc: return "The plan is laid where all seen walls, deviating or not, fit it best (mode uc)";
    case EstimationMode::kSo: return "The plan is laid by one optimization from where it was first put, with no consensus before (mode so)";
  }
  return "The plan is laid where the deviation prior is most probable, which is where most walls stand as planned";
}

class Optimizer {
 public:
  Optimizer(const SGraph& map, const AGraph& plan, const std::vector<WallFrame>& frames, const std::vector<Match>& matches,
            const Eigen::Isometry3d& T_plan_map, const JointOptions& options)
      : map_(map), plan_(plan), frames_(frames), options_(options), fitted_(options), schedule_(ScheduleOf(options.mode)) {
    std::copy_if(matches.begin(), matches.end(), std::back_inserter(matches_),
                 [&](const Match& m) { return !map.surfaces[m.map_surface].observations.empty(); });
    for (const Keyframe& k : map.keyframes) state_.poses.push_back(PoseBlock(k.T_map_kf));
    state_.place = PlaceBlock(T_plan_map);
    for (const Match& m : matches_) {
      if (m.plan_surface.valid()) state_.wall_ids.push_back(plan.surfaces[m.plan_surface.index()].wall);
    }
    std::sort(state_.wall_ids.begin(), state_.wall_ids.end());
    state_.wall_ids.erase(std::unique(state_.wall_ids.begin(), state_.wall_ids.end()), state_.wall_ids.end());
    state_.walls.assign(state_.wall_ids.size(), {});
    responsibilities_.assign(state_.wall_ids.size(), {});
    priors_.assign(state_.wall_ids.size(), Eigen::Vector2d::Zero());
  }

  JointResult Run() {
    JointResult result;
    SeedHeight();
    Measure();
    if (schedule_.consensus) {
      Reseed(true);
      Reseed(true);  // the first correction may turn the plan, and measurements are linear in the turn
    }
    std::optional<JointProblem> problem(std::in_place, map_, plan_, frames_, matches_, fitted_, state_);
    const int rounds = schedule_.alternate ? options_.em_rounds : 1;
    for (int round = 0; round < rounds; ++round) {
      const JointState before = state_;
      const bool moved = round > 0 && schedule_.consensus && Reseed(false);
      const double change = ExpectationStep(*problem);
      if (round > 1 && !moved && change < kSettled) break;  // a seed is no solution
      result.em_rounds = round + 1;
      if (Solve(*problem, result)) continue;
      if (round == 0) return result;
      if (moved) {
        state_ = before;
        Measure();
      }
      break;
    }
    if (options_.covariances && options_.fit_tolerance && schedule_.consensus) {
      FitTolerance();
      problem.reset();  // it holds the state
      problem.emplace(map_, plan_, frames_, matches_, fitted_, state_);
      ExpectationStep(*problem);
      Solve(*problem, result);
    }
    Report(options_.covariances ? problem->Covariances() : std::nullopt, result);
    return result;
  }

 private:
  [[nodiscard]] bool held() const { return schedule_.prior == EstimationSchedule::WallPrior::kHeld; }

  void SeedHeight() {
    state_.place[2] -= ConsensusHeight(LevelVotes(map_, plan_, matches_, Poses(state_), Place()), options_.level_sigma_m);
  }

  // False if it came to nothing: the state stays as it was, which after a first solve is a good one.
  bool Solve(JointProblem& problem, JointResult& result) {
    const JointProblem::Outcome outcome = problem.Solve();
    result.iterations += outcome.iterations;
    result.converged = outcome.converged;
    result.cost = outcome.cost;
    result.message = outcome.message;
    if (outcome.usable) measurements_ = Measured(fitted_);
    return outcome.usable;
  }

  // A building that is truer to its plan than the tolerance tells better where the plan lies than the tolerance would have it.
  void FitTolerance() {
    JointOptions as_thick = options_;
    as_thick.thickness_sigma_m *= kNoThickness;
    const BuiltTolerance built = FitBuiltTolerance(measurements_, Measured(as_thick), responsibilities_, state_.bias_m, options_.coupling);
    fitted_.thickness_sigma_m *= built.offset_ratio;
    fitted_.coupling.offset_tau0_m *= built.offset_ratio;
    fitted_.coupling.yaw_tau0_rad *= built.yaw_ratio;
    Measure();
  }

  [[nodiscard]] std::vector<WallMeasurement> Measured(const JointOptions& options) const {
    return MeasureWalls(map_, plan_, frames_, matches_, Poses(state_), Place(), options);
  }
  void Measure() { measurements_ = Measured(fitted_); }

  // Wall-level consensus on where the plan lies. Between rounds it only steps in when another place is clearly better: then true.
  bool Reseed(bool always) {
    const PlaceSeed seed = SeedPlace(measurements_, frames_, Place(), options_);
    const Eigen::Isometry3d moved = seed.T_plan_map * Place().inverse();
    const Eigen::Vector3d center = Place() * Eigen::Vector3d(state_.poses.back()[4], state_.poses.back()[5], state_.poses.back()[6]);
    constexpr double kElsewhere_m = 0.03;
    if (!always && (moved * center - center).norm() < kElsewhere_m) return false;
    state_.place = PlaceBlock(seed.T_plan_map);
    state_.bias_m = seed.bias_m;
    Measure();
    for (size_t w = 0; w < measurements_.size(); ++w) {
      const Eigen::Vector2d e = measurements_[w].At(state_.bias_m);
      state_.walls[w] = {e.x(), e.y(), 0, 0};
    }
    return true;
  }

  // Which component each wall belongs to; sets the priors accordingly. Returns the largest change.
  double ExpectationStep(JointProblem& problem) {
    double change = 0;
    if (held()) return change;
    for (size_t w = 0; w < measurements_.size(); ++w) {
      const Responsibilities r = AssessMixture(measurements_[w].At(state_.bias_m), measurements_[w].covariance, fitted_.coupling);
      change = std::max(change, PriorChange(responsibilities_[w], r));
      responsibilities_[w] = r;
      const bool uniform = schedule_.prior == EstimationSchedule::WallPrior::kUniform;
      priors_[w] = uniform ? UniformInformation(fitted_.coupling) : PriorInformation(r, fitted_.coupling);
      problem.SetWallPrior(w, priors_[w]);
    }
    return change;
  }

  void Report(const std::optional<JointCovariances>& covariances, JointResult& result) const {
    result.T_plan_map = Place();
    result.T_map_kf = Poses(state_);
    result.range_bias_m = state_.bias_m;
    result.covariances_exact = covariances.has_value();
    if (covariances) {
      constexpr int kPick[3] = {0, 1, 3};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) result.cov_xy_yaw(i, j) = covariances->place(kPick[i], kPick[j]);
    } else {
      result.cov_xy_yaw = Eigen::Vector3d(1, 1, 0.04).asDiagonal();
      if (options_.covariances) result.message += " Rank deficient: covariances are the priors' own, the widest they can be.";
    }
    const bool asks_walls = covariances && schedule_.consensus;
    JointOptions walls_alone =
        options_;  // the place by the rays comes from the same walls: it may choose between places, not make one certain
    walls_alone.place.reset();
    walls_alone.place_sigma_m = JointOptions().place_sigma_m;
    const std::vector<RivalPlace> rivals =
        asks_walls ? RivalPlaces(measurements_, frames_, Place(), walls_alone) : std::vector<RivalPlace>();
    const std::map<WallId, PatchDisagreement> disagreements = asks_walls ? Disagreements() : std::map<WallId, PatchDisagreement>();
    for (size_t w = 0; w < state_.walls.size(); ++w) {
      const auto at = disagreements.find(state_.wall_ids[w]);
      result.walls.push_back(Estimate(w, covariances, rivals, at == disagreements.end() ? nullptr : &at->second));
    }
    CountSeen(map_, plan_, frames_, matches_, Place(), result.walls);
    result.directions = SupportByDirection(measurements_, frames_, state_.bias_m, options_.coupling);
    result.gauge = GaugeText(result);
  }

  [[nodiscard]] std::map<WallId, PatchDisagreement> Disagreements() const {
    std::map<WallId, Eigen::Vector3d> estimates;
    for (size_t w = 0; w < state_.walls.size(); ++w) {
      const auto& wall = state_.walls[w];
      estimates[state_.wall_ids[w]] = {wall[kWallOffset], wall[kWallYaw], wall[kWallThickness]};
    }
    return FindDisagreements(map_, plan_, frames_, matches_, Poses(state_), Place(), estimates, state_.bias_m, options_);
  }

  // The estimated place and its rivals, as this wall would be measured there.
  static std::vector<MeasuredElsewhere> Places(size_t w, const std::vector<RivalPlace>& rivals) {
    std::vector<MeasuredElsewhere> out{{1.0, Eigen::Vector2d::Zero()}};
    double sum = 1;
    for (const RivalPlace& rival : rivals)
      sum += out.emplace_back(MeasuredElsewhere{std::exp(rival.log_odds), rival.shifts[w]}).probability;
    for (MeasuredElsewhere& place : out) place.probability /= sum;
    return out;
  }

  static void Widen(const PatchDisagreement& disagreement, WallEvidence& evidence) {
    if (disagreement.variance_ratio > 1) evidence = {disagreement.mean, disagreement.variance_ratio * evidence.covariance};
    evidence.covariance += disagreement.added;
  }

  WallEstimate Estimate(size_t w, const std::optional<JointCovariances>& covariances, const std::vector<RivalPlace>& rivals,
                        const PatchDisagreement* disagreement) const {
    WallEstimate e;
    e.wall = state_.wall_ids[w];
    e.reference = frames_[e.wall.index()].reference;
    e.deviation = {state_.walls[w][kWallOffset], state_.walls[w][kWallYaw]};
    e.tilt_rad = state_.walls[w][kWallTilt];
    e.thickness_error_m = state_.walls[w][kWallThickness];
    e.p_deviated = responsibilities_[w].any;
    if (!covariances) {
      const CouplingOptions& c = options_.coupling;
      e.cov_all =
          Eigen::Vector4d(c.offset_tau1_m, c.yaw_tau1_rad, options_.tilt_sigma_rad, options_.thickness_sigma_m).cwiseAbs2().asDiagonal();
      e.cov = e.cov_all.topLeftCorner<2, 2>();
      e.evidence.covariance = e.cov;
      return e;
    }
    e.cov_all = covariances->walls[w];
    e.cov = e.cov_all.topLeftCorner<2, 2>();
    if (held()) return e;
    const Eigen::Vector2d estimate(e.deviation.offset_m, e.deviation.yaw_rad);
    e.evidence = WithoutPrior(estimate, e.cov, priors_[w], options_.coupling);
    if (disagreement) Widen(*disagreement, e.evidence);
    const std::vector<MeasuredElsewhere> places = Places(w, rivals);
    for (const MeasuredElsewhere& place : places) e.place_sigma_m += place.probability * place.shift.x() * place.shift.x();
    e.place_sigma_m = std::sqrt(e.place_sigma_m);
    const WallBelief belief = BeliefOf(e.evidence, places, estimate, fitted_.coupling);
    // The prior of what is a deviation does not depend on how well the rest was built; the evidence does, by where that lays the plan.
    e.p_deviated = BeliefOf(e.evidence, places, estimate, options_.coupling).p_deviated;
    // Wider where the solve's covariance is that of one component alone.
    Eigen::Vector4d widen = Eigen::Vector4d::Ones();
    widen.head<2>() = belief.sigma.cwiseQuotient(e.cov.diagonal().cwiseSqrt()).cwiseMax(1.0);
    e.cov_all = widen.asDiagonal() * e.cov_all * widen.asDiagonal();
    e.cov = e.cov_all.topLeftCorner<2, 2>();
    return e;
  }

  std::string GaugeText(const JointResult& result) const {
    std::string text = GaugeRule(options_.mode) + std::string(".");
    for (const DirectionSupport& d : result.directions) {
      if (!d.ambiguous()) continue;
      text += fmt::format(" Along {:.0f} deg the frame is ambiguous: {} {} with it, {} with another.", d.axis_rad * 180 / std::numbers::pi,
                          d.consistent, d.consistent == 1 ? "wall agrees" : "walls agree", d.next_cluster);
    }
    return text;
  }

  [[nodiscard]] Eigen::Isometry3d Place() const { return PlaceOf(state_.place); }

  const SGraph& map_;
  const AGraph& plan_;
  const std::vector<WallFrame>& frames_;
  std::vector<Match> matches_;
  const JointOptions& options_;
  JointOptions fitted_;  // the same, with the tolerance that the building was built to
  const EstimationSchedule schedule_;
  JointState state_;
  std::vector<WallMeasurement> measurements_;
  std::vector<Responsibilities> responsibilities_;
  std::vector<Eigen::Vector2d> priors_;  // per wall, as SetWallPrior has them
};

}  // namespace

std::string JointOptions::Check() const {
  const std::pair<const char*, double> positive[] = {{"point_sigma_m", point_sigma_m},
                                                     {"observation_floor_m", observation_floor_m},
                                                     {"observation_floor_rad", observation_floor_rad},
                                                     {"observation_loss", observation_loss},
                                                     {"gravity_sigma_rad", gravity_sigma_rad},
                                                     {"bias_sigma_m", bias_sigma_m},
                                                     {"thickness_sigma_m", thickness_sigma_m},
                                                     {"tilt_sigma_rad", tilt_sigma_rad},
                                                     {"level_sigma_m", level_sigma_m},
                                                     {"place_sigma_m", place_sigma_m}};
  for (const auto& [name, value] : positive) {
    if (!(value > 0)) return fmt::format("JointOptions.{} = {}; must be > 0", name, value);
  }
  if (std::string fault = odometry.Check(); !fault.empty()) return fault;
  if (!(edge_m2 >= 0)) return fmt::format("JointOptions.edge_m2 = {}; must be >= 0", edge_m2);
  if (!(correlation >= 1)) return fmt::format("JointOptions.correlation = {}; must be >= 1", correlation);
  if (em_rounds < 1) return fmt::format("JointOptions.em_rounds = {}; must be >= 1", em_rounds);
  if (max_iterations < 1) return fmt::format("JointOptions.max_iterations = {}; must be >= 1", max_iterations);
  return coupling.Check();
}

std::vector<WallDeviation> JointResult::Deviations(size_t num_walls) const {
  std::vector<WallDeviation> out(num_walls);
  for (const WallEstimate& w : walls) out[w.wall.index()] = w.deviation;
  return out;
}

JointResult OptimizeJointly(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches, const Eigen::Isometry3d& T_plan_map,
                            const JointOptions& options) {
  const std::vector<WallFrame> frames = WallFrames(plan);
  JointResult failure;
  failure.T_plan_map = T_plan_map;
  failure.message = CheckInput(map, plan, frames, matches, options);
  if (!failure.message.empty()) return failure;
  return Optimizer(map, plan, frames, matches, T_plan_map, options).Run();
}

}  // namespace plumb::runtime
