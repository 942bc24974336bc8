// Global matching: where in the plan is the map? No start pose. Wall voting makes hypotheses, ray casting judges them,
// a posterior over all of them, "outside the plan" among them, decides (runtime/METHOD.md, matching).
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/matching/start_hint.h"
#include "schema/agraph.h"

namespace plumb::runtime {

struct MatcherOptions {
  double yaw_bin_rad = 0.01745;
  double vote_cell_m = 0.10;
  double nms_radius_m = 0.5;
  int max_hypotheses = 200;         // proposals that are verified by ray casting
  int keep_hypotheses = 16;         // reported
  double deviation_sigma_m = 0.10;  // how far built walls are expected off their plan when voting and verifying
  double range_sigma_m = 0.03;
  int rays_per_keyframe = 400;
  int max_keyframes = 24;            // rays come from this many keyframes, spread over the map
  double rays_per_independent = 30;  // correlation: log-likelihoods are divided by this
  double accept_probability = 0.999;
  double accept_margin_nats = 10.0;
  // A hint that prefers a place by hint_lead_nats decides for it against others that the evidence prefers by hint_tie_nats at most.
  double hint_lead_nats = 5.0, hint_tie_nats = 1.0;
  double accept_sigma_xy_m = 0.10;
  double accept_sigma_yaw_rad = 0.0087;
  // ... or the rays prefer the place by accept_margin_nats to all so far off it and more, also without the wall that tells most.
  double nearby_m = 0.3, nearby_yaw_rad = 0.052;
  int accept_min_planes = 5;  // of the plan's walls that the map agrees with; one more for 4 rooms, two for 32, ...
  // Of the map's wall length; the rest may be furniture and deviated walls. Not asked for where rays vouch for the place, or where it leads
  // "outside" by vouch_lead_nats while no other place, nor the plan's mirror image, is better than that.
  double accept_min_consistent_ratio = 0.4;
  double accept_max_through_ratio = 0.02;  // of the rays: may pass through walls of the plan
  int ample_more_planes = 2;               // this many more agree than are asked for: then vouch_max_through_ratio of the rays may
  // The building's size against the plan's: the walls tell it to within this with two sigmas and no farther from the plan's than so many,
  // or the rays prefer the plan to one that is larger or smaller by as much, by vouch_lead_nats. For planar lasers see SizeDoubt().
  double accept_scale_error = 0.025;
  double accept_scale_sigmas = 1.5;
  double accept_scale_bias = 0.005;   // what a lidar's ranges may be off by is no other scale
  double accept_scale_loss_nats = 5;  // by more than this the rays must never prefer a plan that is larger or smaller by accept_scale_error
  // Rays vouch for a place that far fewer walls would not: in furnished or much deviating buildings. They do where this share of them ends
  // on what the plan has there, and the place leads every rival, the plan's mirror image and "outside" by this many nats, and by this much
  // of its own log-likelihood unless nearly all rays end where they should. A smaller part will do of a place that leads those nearby and
  // plans of other sizes by as much. Furniture in the way, where half of the rays of an office may end, says nothing: only those rays count
  // that nothing stops in front, and the lead must be the longer, up to twice, the more are stopped, unless accept_min_planes agree and the
  // place leads those nearby by accept_margin_nats.
  double vouch_explained_ratio = 0.65;
  double vouch_lead_nats = 30;
  double vouch_lead_ratio = 0.3;
  double vouch_sharp_ratio = 0.2;
  double vouch_nearly_all_ratio = 0.9;
  int vouch_min_planes = 4;  // one less where nearly all rays end where they should and few go through walls
  double vouch_max_through_ratio = 0.06;
  double vouch_sigma_xy_m = 0.25;  // the place; which of the walls deviate is left to the coupling
  [[nodiscard]] std::string Check() const;
};

struct Hypothesis {
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();  // gravity-aligned: yaw and translation only
  StoreyId storey;
  double log_likelihood = 0;  // relative to "outside the plan"; with what a hint says
  double probability = 0;
  double sigma_xy_m = 0, sigma_yaw_rad = 0;  // of the map's middle in the plan
  // What speaks for it and against it: planes of the plan that agree, their share of the map's walls, shares of the rays that ended on what
  // the plan has there and that went through planned walls.
  int consistent_planes = 0;
  double consistent_ratio = 0, explained_ratio = 0, through_ratio = 0, in_front_ratio = 0;
};

struct MatchResult {
  enum class Verdict { kSearching, kAmbiguous, kUnique };
  Verdict verdict = Verdict::kSearching;
  std::vector<Hypothesis> hypotheses;  // best first, at most keep_hypotheses
  double probability_outside = 1;
  std::string reason;  // why it is not unique yet; empty when it is
};

struct Guidance;

class Matcher {
 public:
  // Keeps a reference to `plan`, which must outlive it.
  Matcher(const AGraph& plan, const MatcherOptions& options = {});
  ~Matcher();

  // All hypotheses, from nothing or from a hint where the map's first keyframe was. Deterministic.
  [[nodiscard]] MatchResult Match(const SGraph& map, const StartHint& hint = {}) const;

  // Where to drive so that the hypotheses of a match of `map` are told apart; see guidance.h.
  [[nodiscard]] std::optional<Guidance> Guide(const SGraph& map, const MatchResult& match, const Eigen::Isometry3d& T_map_lidar) const;

  // Log-likelihood of each pose, on the same scale as Hypothesis::log_likelihood: for re-scoring an accepted fix against its rivals.
  [[nodiscard]] std::vector<double> Scores(const SGraph& map, std::span<const Eigen::Isometry3d> T_plan_map) const;

  // The pose about `T_plan_map` at which rays (and, unless a planar laser saw them, walls) fit best; within 0.9 m and 9 degrees.
  [[nodiscard]] Eigen::Isometry3d Refined(const SGraph& map, const Eigen::Isometry3d& T_plan_map) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumb::runtime
