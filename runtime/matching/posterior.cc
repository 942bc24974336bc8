#include "runtime/matching/posterior.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "runtime/numerics/symmetric_eigen.h"

namespace plumb::runtime {
namespace {

constexpr double kSamePlace_m = 0.5, kSameYaw_rad = 0.0873, kSameHeight_m = 1.0;
constexpr double kUnknownSigma = 1e3;

struct Sigmas {
  double xy_m = 0, yaw_rad = 0;
};

// A direction that no wall fixes has no finite sigma; a weak prior keeps the inverse defined and says "unknown".
Sigmas SigmasOf(const Eigen::Matrix3d& information) {
  const Eigen::Matrix3d covariance = (information + 1 / (kUnknownSigma * kUnknownSigma) * Eigen::Matrix3d::Identity()).inverse();
  const SymmetricEigen<2> xy = EigenOf(Eigen::Matrix2d(covariance.topLeftCorner<2, 2>()));
  return {std::sqrt(std::max(xy.values[1], 0.0)), std::sqrt(std::max(covariance(2, 2), 0.0))};
}

bool RaysFixPlace(const Candidate& candidate, const MatcherOptions& options) {
  return candidate.lead_nearby && *candidate.lead_nearby >= options.accept_margin_nats;
}

void SetSigmas(const Candidate& candidate, bool rays_vouch, const MatcherOptions& options, Hypothesis& hypothesis) {
  Sigmas sigmas = SigmasOf(rays_vouch ? candidate.fit.place_information : candidate.fit.information);
  if (RaysFixPlace(candidate, options)) {
    // A normal density that loses the lead at the poses nearby.
    const double sigmas_off = std::sqrt(2 * *candidate.lead_nearby);
    sigmas.xy_m = std::min(sigmas.xy_m, options.nearby_m / sigmas_off);
    sigmas.yaw_rad = std::min(sigmas.yaw_rad, options.nearby_yaw_rad / sigmas_off);
  }
  hypothesis.sigma_xy_m = sigmas.xy_m;
  hypothesis.sigma_yaw_rad = sigmas.yaw_rad;
}

Hypothesis ToHypothesis(const Candidate& candidate, const MapView& map, const Eigen::Vector3d& origin, bool rays_vouch,
                        const MatcherOptions& options) {
  Hypothesis h;
  h.T_plan_map = PoseOfMap(candidate.fit.pose, map, origin);
  h.storey = candidate.storey;
  h.log_likelihood = candidate.score();
  h.consistent_planes = candidate.fit.consistent_planes;
  h.consistent_ratio = candidate.fit.consistent_ratio;
  h.explained_ratio = candidate.rays.explained_ratio;
  h.through_ratio = candidate.rays.through_ratio;
  h.in_front_ratio = candidate.rays.in_front_ratio;
  SetSigmas(candidate, rays_vouch, options, h);
  return h;
}

void SetProbabilities(MatchResult& result, double outside) {
  double highest = outside;
  for (const Hypothesis& h : result.hypotheses) highest = std::max(highest, h.log_likelihood);
  double sum = std::exp(outside - highest);
  for (const Hypothesis& h : result.hypotheses) sum += std::exp(h.log_likelihood - highest);
  result.probability_outside = std::exp(outside - highest) / sum;
  for (Hypothesis& h : result.hypotheses) h.probability = std::exp(h.log_likelihood - highest) / sum;
}

// Could `other` be the place as well as `best`? Where the evidence cannot tell, a hint may; against the evidence it may not.
bool IsRival(const Candidate& best, const Candidate& other, const MatcherOptions& options) {
  if (other.rays.log_likelihood > best.rays.log_likelihood + options.hint_tie_nats) return true;
  const double prior_lead = best.log_prior - other.log_prior;
  return best.score() - other.score() < options.accept_margin_nats && prior_lead < options.hint_lead_nats;
}

// `unknown`: what counts as the answer to what was not asked for yet.
bool Vouches(const std::vector<Candidate>& sorted, const WrongPlans& wrong, const MatcherOptions& options, bool unknown) {
  const Candidate& best = sorted.front();
  const RayEvidence& rays = best.rays;
  double rival = std::max(0.0, wrong.mirrored);
  for (size_t i = 1; i < sorted.size(); ++i) rival = std::max(rival, sorted[i].rays.log_likelihood);
  const double lead = rays.log_likelihood - rival, sharp = options.vouch_sharp_ratio * rays.log_likelihood;
  // Rays that furniture stops are not charged, so that foreign plans rise where there are many; but nothing holds their places.
  const bool held = best.fit.consistent_planes >= options.accept_min_planes && (best.lead_nearby ? RaysFixPlace(best, options) : unknown);
  const double least_nats = options.vouch_lead_nats * (held ? 1.0 : std::clamp(4 * rays.in_front_ratio, 1.0, 2.0));
  if (rays.explained_ratio < options.vouch_explained_ratio * (1 - rays.in_front_ratio) || lead < least_nats) return false;
  if (lead >= options.vouch_lead_ratio * rays.log_likelihood || rays.explained_ratio >= options.vouch_nearly_all_ratio) return true;
  const bool sharp_in_place = best.lead_nearby ? *best.lead_nearby >= sharp : unknown;
  const bool sharp_in_size = wrong.scaled ? rays.log_likelihood - *wrong.scaled >= sharp : unknown;
  return lead >= sharp && sharp_in_place && sharp_in_size;
}

std::string OthersAlike(std::ptrdiff_t count) {
  return count == 1 ? "1 other place in the plan looks alike" : fmt::format("{} other places in the plan look alike", count);
}

}  // namespace

bool Distinct(const Candidate& a, const Candidate& b) {
  const PlanarPose &p = a.fit.pose, &q = b.fit.pose;
  return (p.t_m - q.t_m).norm() > kSamePlace_m || std::abs(WrapAngle(p.yaw_rad - q.yaw_rad)) > kSameYaw_rad ||
         std::abs(p.z_m - q.z_m) > kSameHeight_m;
}

std::vector<Candidate> SortAndMerge(std::vector<Candidate> candidates) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) { return a.score() > b.score(); });
  std::vector<Candidate> kept;
  for (Candidate& c : candidates) {
    if (std::all_of(kept.begin(), kept.end(), [&](const Candidate& k) { return Distinct(k, c); })) kept.push_back(std::move(c));
  }
  return kept;
}

int RequiredPlanes(size_t num_rooms, double log_prior, const MatcherOptions& options) {
  const double like_this = static_cast<double>(num_rooms) * std::exp(-std::max(0.0, log_prior));
  return options.accept_min_planes + static_cast<int>(std::lround(std::log10(std::max(1.0, like_this))));
}

bool RaysVouch(const std::vector<Candidate>& sorted, const WrongPlans& wrong, const MatcherOptions& options) {
  return Vouches(sorted, wrong, options, false);
}

bool MayVouch(const std::vector<Candidate>& sorted, const WrongPlans& wrong, const MatcherOptions& options) {
  return Vouches(sorted, wrong, options, true);
}

bool StandsAlone(const std::vector<Candidate>& sorted, double mirrored, const MatcherOptions& options) {
  const auto fits = [](const Candidate& c) { return c.rays.log_likelihood > 0; };
  return sorted.size() > 1 && sorted.front().rays.log_likelihood >= options.vouch_lead_nats && mirrored <= 0 &&
         std::none_of(sorted.begin() + 1, sorted.end(), fits);
}

bool WallsFixPlace(const WallFit& fit, const MatcherOptions& options) {
  const Sigmas sigmas = SigmasOf(fit.information);
  return sigmas.xy_m <= options.accept_sigma_xy_m && sigmas.yaw_rad <= options.accept_sigma_yaw_rad;
}

bool WallsTellScale(const WallFit& fit, const MatcherOptions& options) {
  return std::abs(fit.scale_error) + 2 * fit.sigma_scale <= options.accept_scale_error &&
         std::abs(fit.scale_error) <= std::max(options.accept_scale_sigmas * fit.sigma_scale, options.accept_scale_bias);
}

std::string Doubt(const Candidate& candidate, const Hypothesis& hypothesis, int required_planes, const RayVerdict& by_rays,
                  const std::optional<double>& scaled, const MatcherOptions& options) {
  const WallFit& fit = candidate.fit;
  const bool rays_vouch = by_rays.vouch;
  const bool ample = rays_vouch || fit.consistent_planes >= required_planes + options.ample_more_planes;
  if (rays_vouch) {
    const bool nearly_all = candidate.rays.explained_ratio >= options.vouch_nearly_all_ratio &&
                            candidate.rays.through_ratio <= options.accept_max_through_ratio;
    required_planes = std::min(required_planes, options.vouch_min_planes - (nearly_all ? 1 : 0));
  }
  const double max_sigma_xy_m = rays_vouch ? options.vouch_sigma_xy_m : options.accept_sigma_xy_m;
  if (!RaysFixPlace(candidate, options) &&
      (hypothesis.sigma_xy_m > max_sigma_xy_m || hypothesis.sigma_yaw_rad > options.accept_sigma_yaw_rad)) {
    return "too few walls agree to fix the position in every direction";
  }
  if (fit.consistent_planes < required_planes) {
    return fmt::format("only {} wall planes agree with the plan, {} are asked for", fit.consistent_planes, required_planes);
  }
  const bool few_agree = !rays_vouch && fit.consistent_ratio < options.accept_min_consistent_ratio;
  if (few_agree && !by_rays.stands_alone) {
    return fmt::format("only {:.0f} % of the walls seen agree with the plan", 100 * fit.consistent_ratio);
  }
  if (candidate.rays.through_ratio > (ample && !few_agree ? options.vouch_max_through_ratio : options.accept_max_through_ratio)) {
    return fmt::format("{:.1f} % of the rays went through walls of the plan", 100 * candidate.rays.through_ratio);
  }
  const bool rays_tell_scale = scaled && candidate.rays.log_likelihood - *scaled >= options.vouch_lead_nats;
  if (!rays_tell_scale && !WallsTellScale(fit, options)) {
    return fmt::format("the scale is {:+.1f} +- {:.1f} % off the plan's", 100 * fit.scale_error, 100 * fit.sigma_scale);
  }
  // Whatever the few walls say that agree: of a plan too large the others pass for deviated ones.
  if (scaled && *scaled - candidate.rays.log_likelihood > options.accept_scale_loss_nats) {
    return fmt::format("a plan of another size fits better ({:+.1f} nats)", *scaled - candidate.rays.log_likelihood);
  }
  return {};
}

std::string SizeDoubt(const Candidate& candidate, const std::optional<double>& scaled, const MatcherOptions& options) {
  const double sigmas = std::max(0.0, options.accept_scale_error - std::abs(candidate.fit.scale_error)) / candidate.fit.sigma_scale;
  const double for_other_size = scaled ? std::max(0.0, *scaled - candidate.rays.log_likelihood) : 0;
  const double lead = 0.5 * sigmas * sigmas - for_other_size;
  const bool bent_so_far = for_other_size <= options.vouch_lead_ratio * candidate.rays.log_likelihood;
  if (lead >= options.accept_margin_nats && bent_so_far) return {};
  return fmt::format("a plan of another size fits about as well ({:+.1f} nats)", bent_so_far ? -lead : for_other_size);
}

std::string PlaceDoubt(const Candidate& candidate) {
  if (candidate.lead_nearby.value_or(0) >= 0) return {};
  return fmt::format("a place beside it fits better ({:+.1f} nats)", -*candidate.lead_nearby);
}

std::string StoreyDoubt(const Candidate& candidate, const MatcherOptions& options) {
  if (!candidate.lead_over_storeys || *candidate.lead_over_storeys >= options.accept_margin_nats) return {};
  return fmt::format("but for one wall, another storey fits about as well ({:+.1f} nats)", -*candidate.lead_over_storeys);
}

MatchResult Decide(const std::vector<Candidate>& sorted, const MapView& map, const AGraph& plan, const MatcherOptions& options,
                   const WrongPlans& wrong) {
  MatchResult result;
  if (sorted.empty()) {
    result.reason = "no pose in the plan puts the map's walls on planned ones";
    return result;
  }
  const size_t n = std::min(sorted.size(), static_cast<size_t>(options.keep_hypotheses));
  const RayVerdict by_rays{RaysVouch(sorted, wrong, options), StandsAlone(sorted, wrong.mirrored, options)};
  for (size_t i = 0; i < n; ++i) {
    result.hypotheses.push_back(ToHypothesis(sorted[i], map, plan.origin, by_rays.vouch && i == 0, options));
  }
  SetProbabilities(result, std::max(0.0, wrong.mirrored));
  const Hypothesis& best = result.hypotheses.front();
  // A hint says where in the plan, not that it is the building's: here only the evidence counts.
  const double evidence = sorted.front().rays.log_likelihood;
  if (evidence < options.accept_margin_nats) {
    result.reason = fmt::format("the best pose is no better than a place outside the plan ({:+.1f} nats)", evidence);
    return result;
  }
  if (evidence - wrong.mirrored < options.accept_margin_nats) {
    result.reason = fmt::format("a mirror image of the plan fits about as well ({:+.1f} nats)", wrong.mirrored - evidence);
    return result;
  }
  const auto rivals = std::count_if(sorted.begin() + 1, sorted.begin() + static_cast<ptrdiff_t>(n),
                                    [&](const Candidate& c) { return IsRival(sorted.front(), c, options); });
  const int required_planes = RequiredPlanes(plan.rooms.size(), sorted.front().log_prior, options);
  result.reason = Doubt(sorted.front(), best, required_planes, by_rays, map.planar ? std::nullopt : wrong.scaled, options);
  if (map.planar && result.reason.empty()) result.reason = SizeDoubt(sorted.front(), wrong.scaled, options);
  if (map.planar && result.reason.empty()) result.reason = PlaceDoubt(sorted.front());
  if (result.reason.empty()) result.reason = StoreyDoubt(sorted.front(), options);
  if (!result.reason.empty()) {
    if (rivals > 0) result.reason += "; " + OthersAlike(rivals);
    return result;
  }
  if (rivals > 0) {
    result.verdict = MatchResult::Verdict::kAmbiguous;
    result.reason = OthersAlike(rivals);
  } else if (best.probability < options.accept_probability) {
    result.reason = fmt::format("its probability is only {:.4f}", best.probability);
  } else {
    result.verdict = MatchResult::Verdict::kUnique;
  }
  return result;
}

}  // namespace plumb::runtime
