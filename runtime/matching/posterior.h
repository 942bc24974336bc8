// From judged poses to a verdict.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/matching/matcher.h"
#include "runtime/matching/ray_likelihood.h"
#include "runtime/matching/refine.h"

namespace plumb::runtime {

struct Candidate {
  WallFit fit;
  RayEvidence rays;
  StoreyId storey;
  double log_prior = 0;  // of the robot's start, by a hint
  // By how much the rays prefer it to poses a little off it (LeadOver); none: not asked for yet, as its walls fix it or too few of them
  // agree.
  std::optional<double> lead_nearby;
  // The same over the same place in the plan's other storeys; none: not asked for yet.
  std::optional<double> lead_over_storeys;

  [[nodiscard]] double score() const { return rays.log_likelihood + log_prior; }
};

// Log-likelihoods of the best poses in plans that are not the building's.
struct WrongPlans {
  double mirrored = 0;           // in the plan's mirror image; "outside the plan" is at least as likely
  std::optional<double> scaled;  // near the best pose in the plan larger or smaller by accept_scale_error; none: not tried yet
};

// Two poses of one map that no one would call the same place.
[[nodiscard]] bool Distinct(const Candidate& a, const Candidate& b);

// Best first; of those that are about the same pose only the best.
[[nodiscard]] std::vector<Candidate> SortAndMerge(std::vector<Candidate> candidates);

// `sorted`: from SortAndMerge. Poses are given as T_plan_map, AGraph::origin and the map's centre put back.
[[nodiscard]] MatchResult Decide(const std::vector<Candidate>& sorted, const MapView& map, const AGraph& plan,
                                 const MatcherOptions& options, const WrongPlans& wrong = {});

// Planes that must agree in a plan of so many rooms: the more there are, the more of them look alike by chance. A hint leaves fewer of
// them.
[[nodiscard]] int RequiredPlanes(size_t num_rooms, double log_prior, const MatcherOptions& options);

// Whether the rays alone tell the place (see MatcherOptions). `sorted` must not be empty.
[[nodiscard]] bool RaysVouch(const std::vector<Candidate>& sorted, const WrongPlans& wrong, const MatcherOptions& options);

// Whether they might, if what was not asked for yet (Candidate::lead_nearby of the best, WrongPlans::scaled) were all for it.
[[nodiscard]] bool MayVouch(const std::vector<Candidate>& sorted, const WrongPlans& wrong, const MatcherOptions& options);

// Whether the best is the only place at which the rays fit: by vouch_lead_nats better than "outside the plan", while all others, the best
// in the plan's mirror image among them, are no better than that. Without another there is nothing to tell by. `sorted` must not be empty.
[[nodiscard]] bool StandsAlone(const std::vector<Candidate>& sorted, double mirrored, const MatcherOptions& options);

// What the rays say about the best place, beside how well they fit.
struct RayVerdict {
  bool vouch = false, stands_alone = false;  // RaysVouch(), StandsAlone()
};

// Whether the walls alone fix the place in every direction to within accept_sigma_xy_m and accept_sigma_yaw_rad.
[[nodiscard]] bool WallsFixPlace(const WallFit& fit, const MatcherOptions& options);

// Whether the walls tell the building's size to within accept_scale_error, and that it is the plan's.
[[nodiscard]] bool WallsTellScale(const WallFit& fit, const MatcherOptions& options);

// Why this pose alone, rivals aside, is not yet trusted; empty if it is. `scaled`: see WrongPlans.
[[nodiscard]] std::string Doubt(const Candidate& candidate, const Hypothesis& hypothesis, int required_planes, const RayVerdict& by_rays,
                                const std::optional<double>& scaled, const MatcherOptions& options);

// The same for the size of a map of a planar laser, which is bent: plans of other sizes may suit its rays better, so that their word counts
// against the plan and not for it. Its walls must tell the size by accept_margin_nats more than that, and more than vouch_lead_ratio of the
// rays' own word no walls make up for: those that agree are chosen for agreeing.
[[nodiscard]] std::string SizeDoubt(const Candidate& candidate, const std::optional<double>& scaled, const MatcherOptions& options);

// Of a map of a planar laser, whose walls are half furniture: whether the rays prefer a place a little off once the wall that tells most is
// left out. In a plan of another size one part of the map lies well here and the rest beside it. Empty if not asked for yet.
[[nodiscard]] std::string PlaceDoubt(const Candidate& candidate);

// Whether another storey, which often has the same walls, fits about as well but for one wall: that may be the one that deviates. Empty if
// not asked for yet.
[[nodiscard]] std::string StoreyDoubt(const Candidate& candidate, const MatcherOptions& options);

}  // namespace plumb::runtime
