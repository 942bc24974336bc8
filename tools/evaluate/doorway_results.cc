#include "tools/evaluate/doorway_results.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace plumb::tools {
namespace {

constexpr double kAccurate_m = 0.04, kAccurateSigmas = 2;

double Off(const DoorwayTruth& d) { return std::max(std::abs(d.shift_m), std::abs(d.width_deviation_m)); }

bool IsAccurate(double error_m, double sigma_m) { return std::abs(error_m) <= std::max(kAccurate_m, kAccurateSigmas * sigma_m); }

WallOutcome OutcomeOf(const DoorwayResult& r, const std::string& status, bool observed) {
  if (status == "deviated") {
    const bool accurate = IsAccurate(r.shift_m - r.true_shift_m, r.sigma_shift_m) &&
                          IsAccurate(r.width_deviation_m - r.true_width_deviation_m, r.sigma_width_m);
    return accurate ? WallOutcome::kFound : WallOutcome::kInaccurate;
  }
  if (!observed) return WallOutcome::kUnobserved;
  return status == "unobserved" ? WallOutcome::kUnjudged : WallOutcome::kMissed;
}

}  // namespace

size_t DoorwayScore::Count(WallOutcome outcome) const {
  return static_cast<size_t>(std::count_if(results.begin(), results.end(), [&](const DoorwayResult& r) { return r.outcome == outcome; }));
}

DoorwayScore CompareDoorways(const Truth& truth, const Deviations& reported, double min_points, bool localized) {
  DoorwayScore score;
  double sum_m = 0, covered = 0;
  for (const DoorwayTruth& t : truth.doorways) {
    const auto entry =
        std::find_if(reported.doorways.begin(), reported.doorways.end(), [&](const DoorwayEntry& d) { return d.id == t.id; });
    const DoorwayEntry d = entry == reported.doorways.end() ? DoorwayEntry{.id = t.id, .guid = {}, .status = "unobserved"} : *entry;
    DoorwayResult r;
    r.id = t.id;
    r.guid = t.guid;
    r.true_shift_m = t.shift_m;
    r.true_width_deviation_m = t.width_deviation_m;
    r.measured = d.status == "deviated" || d.status == "as_planned";
    r.shift_m = d.shift_m;
    r.sigma_shift_m = d.sigma_shift_m;
    r.width_deviation_m = d.width_deviation_m;
    r.sigma_width_m = d.sigma_width_m;
    if (r.measured) {
      ++score.measured;
      for (const auto& [error_m, sigma_m] :
           {std::pair(r.shift_m - t.shift_m, r.sigma_shift_m), std::pair(r.width_deviation_m - t.width_deviation_m, r.sigma_width_m)}) {
        sum_m += std::abs(error_m);
        score.max_error_m = std::max(score.max_error_m, std::abs(error_m));
        covered += std::abs(error_m) <= 2 * sigma_m ? 1 : 0;
      }
    }
    const bool accused = d.status == "deviated" || d.status == "missing";
    if (Off(t) >= DoorwayResult::kDeviates_m) {
      r.outcome = OutcomeOf(r, d.status, localized && t.rays_through >= min_points);
      score.results.push_back(r);
    } else if (accused && (d.status == "missing" || Off(t) < 0.5 * DoorwayResult::kDeviates_m)) {
      r.outcome = WallOutcome::kFalse;
      score.results.push_back(r);
    }
  }
  if (score.measured > 0) {
    score.mean_error_m = sum_m / (2 * static_cast<double>(score.measured));
    score.coverage = covered / (2 * static_cast<double>(score.measured));
  }
  const auto found = static_cast<double>(score.Count(WallOutcome::kFound) + score.Count(WallOutcome::kInaccurate));
  const auto missed = static_cast<double>(score.Count(WallOutcome::kMissed)), wrong = static_cast<double>(score.Count(WallOutcome::kFalse));
  if (found + wrong > 0) score.precision = found / (found + wrong);
  if (found + missed > 0) score.recall = found / (found + missed);
  std::sort(score.results.begin(), score.results.end(), [](const DoorwayResult& a, const DoorwayResult& b) {
    return std::tie(a.outcome, a.id.value) < std::tie(b.outcome, b.id.value);
  });
  return score;
}

}  // namespace plumb::tools
