#include "runtime/matching/matcher.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/matching/aliases.h"
#include "runtime/matching/guidance.h"
#include "runtime/matching/hypotheses.h"
#include "runtime/matching/mirror.h"
#include "runtime/matching/posterior.h"
#include "runtime/matching/refine_on_rays.h"

namespace plumb::runtime {
namespace {

constexpr size_t kCoarseRays = 500;
constexpr size_t kNearbyRays = 2000;  // enough to tell 0.3 m from 0
constexpr int kNearbyDirections = 8;
constexpr int kLeastPlanes = 3;  // with fewer no place is accepted
constexpr int kFinalistsPerKept = 2;
constexpr size_t kRefinedOnRays = 2;  // at least: the best and its rival
constexpr size_t kAliasedFinalists = 8;
constexpr double kSensorHeights_m[] = {0.3, 0.6, 0.9, 1.2, 1.5};
constexpr double kLowestMargin_m = 0.1;

// Finds the likely poses of a map in one plan.
class PoseSearch {
 public:
  PoseSearch(const AGraph& graph, const MatcherOptions& search_options) : plan(graph), options(search_options) {}
  // In the mirror image of another's plan.
  PoseSearch(const AGraph& image, const PoseSearch& original) : plan(image, original.plan), options(original.options) {}

  // Refined and judged by all rays, best first.
  [[nodiscard]] std::vector<Candidate> Finalists(const MapView& map, const StartHint& hint = {}) const {
    std::vector<PlanarPose> poses;
    for (const Proposal& p : ProposePoses(plan, map, options)) poses.push_back(p.pose);
    std::vector<Candidate> candidates = SortAndMerge(Judged(map, poses, hint));
    if (!plan.plan().aliases.empty()) {
      const std::vector<Candidate> aliased = Judged(map, Aliases(candidates), hint);
      candidates.insert(candidates.end(), aliased.begin(), aliased.end());
      candidates = SortAndMerge(std::move(candidates));
    }
    candidates.resize(std::min(candidates.size(), static_cast<size_t>(kFinalistsPerKept * options.keep_hypotheses)));
    oneapi::tbb::parallel_for(size_t{0}, candidates.size(),
                              [&](size_t i) { candidates[i].rays = JudgeRays(plan, map, candidates[i].fit.pose, options); });
    candidates = SortAndMerge(std::move(candidates));
    RefineThatMatter(map, candidates);
    return SortAndMerge(std::move(candidates));
  }

  // Log-likelihood that the candidate's place gains at most in a plan of another scale.
  [[nodiscard]] double ScaledLikelihood(const MapView& map, const Candidate& candidate) const {
    double best = -1e300;
    for (const double scale : {1 - options.accept_scale_error, 1 + options.accept_scale_error}) {
      const MapView scaled = Scaled(map, scale);
      Candidate there = candidate;
      there.fit = RefineOnWalls(plan, scaled, candidate.fit.pose);
      there.fit.pose.z_m = candidate.fit.pose.z_m;
      there.rays = JudgeRays(plan, scaled, there.fit.pose, options);
      RefineOnRays(scaled, there);
      best = std::max(best, there.rays.log_likelihood);
    }
    return best;
  }

  // Candidate::lead_nearby.
  [[nodiscard]] double LeadNearby(const MapView& map, const PlanarPose& pose) const {
    std::vector<PlanarPose> others;
    for (const double distance_m : {options.nearby_m, 2 * options.nearby_m, 4 * options.nearby_m}) {
      for (int i = 0; i < kNearbyDirections; ++i) {
        const double angle_rad = 2 * std::numbers::pi * i / kNearbyDirections;
        others.push_back(pose);
        others.back().t_m += distance_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
      }
    }
    for (const int turns : {-2, -1, 1, 2}) {
      others.push_back(pose);
      others.back().yaw_rad += turns * options.nearby_yaw_rad;
    }
    return LeadOver(plan, map, pose, others, options, Stride(map, kNearbyRays));
  }

  // Candidate::lead_over_storeys.
  [[nodiscard]] double LeadOverStoreys(const MapView& map, const PlanarPose& pose) const {
    std::vector<PlanarPose> others;
    const PlanLevel* const own = LevelAt(map, pose.z_m);
    for (const PlanLevel& level : plan.levels()) {
      if (&level == own) continue;
      others.push_back(pose);
      others.back().z_m += level.floor_z_m - own->floor_z_m;
    }
    return LeadOver(plan, map, pose, others, options, Stride(map, kNearbyRays), true);
  }

  const PlanIndex plan;
  const MatcherOptions options;

 private:
  [[nodiscard]] static size_t Stride(const MapView& map, size_t num_rays) { return std::max<size_t>(1, map.rays.size() / num_rays); }

  // The best, and all that might be its rivals if they gained as much as others did. `sorted`: best first.
  void RefineThatMatter(const MapView& map, std::vector<Candidate>& sorted) const {
    double best = -1e300, gained = 0;
    for (size_t i = 0; i < sorted.size(); ++i) {
      const double before = sorted[i].score();
      if (i >= kRefinedOnRays && before + gained + options.accept_margin_nats < best) return;
      RefineOnRays(map, sorted[i]);
      gained = std::max(gained, sorted[i].score() - before);
      best = std::max(best, sorted[i].score());
    }
  }

  void RefineOnRays(const MapView& map, Candidate& candidate) const {
    const PlanarPose pose = runtime::RefineOnRays(plan, map, candidate.fit, options);
    const RayEvidence rays = JudgeRays(plan, map, pose, options);
    if (rays.log_likelihood <= candidate.rays.log_likelihood) return;
    candidate.fit = AssessOnWalls(plan, map, pose);
    candidate.rays = rays;
  }

  // Whose floor is nearest to the map's. None: the plan has no rooms.
  [[nodiscard]] const PlanLevel* LevelAt(const MapView& map, double z_m) const {
    const double floor_z_m = (map.floor_z_m ? *map.floor_z_m : map.sensor_z_m - 0.6) + z_m;
    const auto nearest = std::min_element(plan.levels().begin(), plan.levels().end(), [&](const PlanLevel& a, const PlanLevel& b) {
      return std::abs(a.floor_z_m - floor_z_m) < std::abs(b.floor_z_m - floor_z_m);
    });
    return nearest == plan.levels().end() ? nullptr : &*nearest;
  }

  // The heights that a pose may have. Walls look alike at any height, so there is more than one without a floor or ceiling, and where the
  // floor may be a table.
  [[nodiscard]] std::vector<double> Heights(const MapView& map, const PlanarPose& pose) const {
    std::vector<double> heights;
    if (map.floor_z_m || map.ceiling_z_m) {
      heights.push_back(pose.z_m);
      for (const double floor_z_m : map.lower_floors_z_m) heights.push_back(pose.z_m + *map.floor_z_m - floor_z_m);
      return heights;
    }
    for (double height_m : kSensorHeights_m) {
      if (map.sensor_z_m - height_m > map.lowest_z_m + kLowestMargin_m) continue;  // points below the floor
      heights.push_back(pose.z_m + height_m - 0.6);
    }
    if (heights.empty()) heights.push_back(pose.z_m + (map.sensor_z_m - map.lowest_z_m) - 0.6);
    return heights;
  }

  [[nodiscard]] Candidate Judged(const MapView& map, const WallFit& fit, size_t stride) const {
    Candidate best;
    for (double z_m : Heights(map, fit.pose)) {
      Candidate c;
      c.fit = fit;
      c.fit.pose.z_m = z_m;
      c.rays = JudgeRays(plan, map, c.fit.pose, options, stride);
      if (best.fit.pairs.empty() || c.rays.log_likelihood > best.rays.log_likelihood) best = c;
    }
    const PlanLevel* const level = LevelAt(map, best.fit.pose.z_m);
    best.storey = level != nullptr ? level->storey : StoreyId();
    return best;
  }

  // Of the robot, plan frame.
  [[nodiscard]] Eigen::Vector3d StartOf(const MapView& map, const PlanarPose& pose) const {
    const Eigen::Vector2d start_m = pose.rotation() * map.start_m + pose.t_m;
    return plan.plan().origin + Eigen::Vector3d(start_m.x(), start_m.y(), map.sensor_z_m + pose.z_m);
  }

  // Refined and judged by a few rays.
  [[nodiscard]] std::vector<Candidate> Judged(const MapView& map, const std::vector<PlanarPose>& poses, const StartHint& hint) const {
    std::vector<Candidate> candidates(poses.size());
    const size_t stride = Stride(map, kCoarseRays);
    oneapi::tbb::parallel_for(size_t{0}, poses.size(), [&](size_t i) {
      const WallFit fit = RefineOnWalls(plan, map, poses[i]);
      if (fit.pairs.empty()) return;
      candidates[i] = Judged(map, fit, stride);
      candidates[i].log_prior = LogPrior(plan.plan(), hint, StartOf(map, candidates[i].fit.pose));
    });
    std::erase_if(candidates, [](const Candidate& c) { return c.fit.pairs.empty(); });
    return candidates;
  }

  // Where the plan's own symmetries take the best: each must be beaten explicitly.
  [[nodiscard]] std::vector<PlanarPose> Aliases(const std::vector<Candidate>& sorted) const {
    std::vector<PlanarPose> poses;
    for (size_t i = 0; i < std::min(sorted.size(), kAliasedFinalists); ++i) {
      for (const PlanarPose& pose : AliasedPoses(plan.plan(), sorted[i].fit.pose)) poses.push_back(pose);
    }
    return poses;
  }
};

}  // namespace

std::string MatcherOptions::Check() const {
  const auto bad = [](const char* name, double value, const char* rule) {
    return fmt::format("MatcherOptions.{} = {}; must be {}", name, value, rule);
  };
  if (!(yaw_bin_rad > 0.001 && yaw_bin_rad < 0.2)) return bad("yaw_bin_rad", yaw_bin_rad, "in (0.001, 0.2)");
  if (!(vote_cell_m >= 0.02 && vote_cell_m <= 1)) return bad("vote_cell_m", vote_cell_m, "in [0.02, 1]");
  if (!(nms_radius_m >= 0)) return bad("nms_radius_m", nms_radius_m, "at least 0");
  if (max_hypotheses < 1) return bad("max_hypotheses", max_hypotheses, "at least 1");
  if (keep_hypotheses < 2) return bad("keep_hypotheses", keep_hypotheses, "at least 2");
  if (!(deviation_sigma_m > 0)) return bad("deviation_sigma_m", deviation_sigma_m, "positive");
  if (!(range_sigma_m > 0)) return bad("range_sigma_m", range_sigma_m, "positive");
  if (rays_per_keyframe < 1) return bad("rays_per_keyframe", rays_per_keyframe, "at least 1");
  if (max_keyframes < 1) return bad("max_keyframes", max_keyframes, "at least 1");
  if (!(rays_per_independent >= 1)) return bad("rays_per_independent", rays_per_independent, "at least 1");
  if (!(accept_probability > 0.5 && accept_probability < 1)) return bad("accept_probability", accept_probability, "in (0.5, 1)");
  if (!(accept_margin_nats > 0)) return bad("accept_margin_nats", accept_margin_nats, "positive");
  if (!(hint_lead_nats > 0)) return bad("hint_lead_nats", hint_lead_nats, "positive");
  if (!(hint_tie_nats >= 0)) return bad("hint_tie_nats", hint_tie_nats, "at least 0");
  if (!(accept_sigma_xy_m > 0)) return bad("accept_sigma_xy_m", accept_sigma_xy_m, "positive");
  if (!(accept_sigma_yaw_rad > 0)) return bad("accept_sigma_yaw_rad", accept_sigma_yaw_rad, "positive");
  if (!(nearby_m > 0)) return bad("nearby_m", nearby_m, "positive");
  if (!(nearby_yaw_rad > 0)) return bad("nearby_yaw_rad", nearby_yaw_rad, "positive");
  if (accept_min_planes < 3) return bad("accept_min_planes", accept_min_planes, "at least 3");
  if (!(accept_min_consistent_ratio >= 0 && accept_min_consistent_ratio <= 1)) {
    return bad("accept_min_consistent_ratio", accept_min_consistent_ratio, "in [0, 1]");
  }
  if (!(vouch_explained_ratio > 0)) return bad("vouch_explained_ratio", vouch_explained_ratio, "positive");
  if (!(vouch_lead_ratio > 0)) return bad("vouch_lead_ratio", vouch_lead_ratio, "positive");
  if (!(vouch_sharp_ratio > 0)) return bad("vouch_sharp_ratio", vouch_sharp_ratio, "positive");
  if (!(vouch_nearly_all_ratio > 0)) return bad("vouch_nearly_all_ratio", vouch_nearly_all_ratio, "positive");
  if (!(vouch_lead_nats > 0)) return bad("vouch_lead_nats", vouch_lead_nats, "positive");
  if (vouch_min_planes < 3) return bad("vouch_min_planes", vouch_min_planes, "at least 3");
  if (!(vouch_max_through_ratio >= 0)) return bad("vouch_max_through_ratio", vouch_max_through_ratio, "at least 0");
  if (!(vouch_sigma_xy_m > 0)) return bad("vouch_sigma_xy_m", vouch_sigma_xy_m, "positive");
  if (!(accept_max_through_ratio >= 0)) return bad("accept_max_through_ratio", accept_max_through_ratio, "at least 0");
  if (ample_more_planes < 0) return bad("ample_more_planes", ample_more_planes, "at least 0");
  if (!(accept_scale_error > 0)) return bad("accept_scale_error", accept_scale_error, "positive");
  if (!(accept_scale_bias >= 0)) return bad("accept_scale_bias", accept_scale_bias, ">= 0");
  if (!(accept_scale_loss_nats >= 0)) return bad("accept_scale_loss_nats", accept_scale_loss_nats, "at least 0");
  if (!(accept_scale_sigmas > 0)) return bad("accept_scale_sigmas", accept_scale_sigmas, "positive");
  return {};
}

struct Matcher::Impl {
  PoseSearch search;
  AGraph mirror_image;
  PoseSearch mirrored;

  Impl(const AGraph& plan, const MatcherOptions& options)
      : search(plan, options), mirror_image(MirrorImage(plan)), mirrored(mirror_image, search) {}

  // Log-likelihood of the best pose in the mirror image, 0 if there is none. Where the mirror image is the plan itself it is no other
  // building: then of the best pose at which it is not.
  [[nodiscard]] double MirroredLikelihood(const MapView& map, const WallFit& fit) const {
    for (const Candidate& c : mirrored.Finalists(map)) {
      if (!IsOwnMirrorImage(search.plan, fit, c.fit.pose)) return std::max(0.0, c.rays.log_likelihood);
    }
    return 0;
  }
};

Matcher::Matcher(const AGraph& plan, const MatcherOptions& options) : impl_(std::make_unique<Impl>(plan, options)) {}
Matcher::~Matcher() = default;

MatchResult Matcher::Match(const SGraph& map, const StartHint& hint) const {
  const PoseSearch& search = impl_->search;
  const MapView view = ViewMap(map, search.options);
  MatchResult result;
  if (search.plan.faces().empty() || search.plan.plan().mesh.triangles.empty()) {
    result.reason = "the plan has no walls";
    return result;
  }
  if (view.walls.size() < 2 || view.rays.empty()) {
    result.reason = "the map has fewer than two walls";
    return result;
  }
  std::vector<Candidate> finalists = search.Finalists(view, hint);
  const AGraph& plan = search.plan.plan();
  WrongPlans wrong;
  if (!finalists.empty()) {
    Candidate& best = finalists.front();
    if (!view.planar && !WallsTellScale(best.fit, search.options)) wrong.scaled = search.ScaledLikelihood(view, best);
    if (best.fit.consistent_planes >= kLeastPlanes) {
      const auto may_decide = [&] { return MayVouch(finalists, wrong, search.options) && !RaysVouch(finalists, wrong, search.options); };
      if (!WallsFixPlace(best.fit, search.options) || may_decide()) best.lead_nearby = search.LeadNearby(view, best.fit.pose);
      if (!wrong.scaled && may_decide()) wrong.scaled = search.ScaledLikelihood(view, best);
    }
  }
  result = Decide(finalists, view, plan, search.options, wrong);
  if (result.verdict != MatchResult::Verdict::kUnique) return result;
  Candidate& best = finalists.front();
  if (!wrong.scaled) wrong.scaled = search.ScaledLikelihood(view, best);
  if (view.planar && !best.lead_nearby) best.lead_nearby = search.LeadNearby(view, best.fit.pose);
  best.lead_over_storeys = search.LeadOverStoreys(view, best.fit.pose);
  wrong.mirrored = impl_->MirroredLikelihood(view, best.fit);
  return Decide(finalists, view, plan, search.options, wrong);
}

std::optional<Guidance> Matcher::Guide(const SGraph& map, const MatchResult& match, const Eigen::Isometry3d& T_map_lidar) const {
  return runtime::Guide(impl_->search.plan, map, match, T_map_lidar, impl_->search.options);
}

std::vector<double> Matcher::Scores(const SGraph& map, std::span<const Eigen::Isometry3d> T_plan_map) const {
  const PoseSearch& search = impl_->search;
  const MapView view = ViewMap(map, search.options);
  std::vector<double> scores;
  for (const Eigen::Isometry3d& T : T_plan_map) {
    const PlanarPose pose = PoseOfView(T, view, search.plan.plan().origin);
    scores.push_back(JudgeRays(search.plan, view, pose, search.options).log_likelihood);
  }
  return scores;
}

Eigen::Isometry3d Matcher::Refined(const SGraph& map, const Eigen::Isometry3d& T_plan_map) const {
  const PoseSearch& search = impl_->search;
  const Eigen::Vector3d& origin = search.plan.plan().origin;
  const MapView view = ViewMap(map, search.options);
  const PlanarPose given = PoseOfView(T_plan_map, view, origin);
  const PlanarPose refined = RefineOnRays(search.plan, view, AssessOnWalls(search.plan, view, given), search.options);
  const auto score = [&](const PlanarPose& pose) { return JudgeRays(search.plan, view, pose, search.options).log_likelihood; };
  return score(refined) > score(given) ? PoseOfMap(refined, view, origin) : T_plan_map;  // by all rays, not those climbed on alone
}

}  // namespace plumb::runtime
