#include "tools/evaluate/wall_results.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace plumb::tools {
namespace {

using SurfacesOfWall = std::map<std::string, std::vector<const SurfaceEntry*>>;

constexpr double kAccurate_m = 0.04, kAccurateSigmas = 2;

bool ReportedOff(const SurfaceEntry& s) { return s.status == "deviated"; }

bool Observed(const std::vector<const SurfaceEntry*>& surfaces, const Truth& truth, double min_points) {
  return std::any_of(surfaces.begin(), surfaces.end(), [&](const SurfaceEntry* s) {
    if (truth.surface_points.empty()) return s->status != "unobserved";
    const auto hits = truth.surface_points.find(s->id);
    return hits != truth.surface_points.end() && hits->second >= min_points;
  });
}

// What surface `id` of the wall really does; surfaces that truth.json does not list move as the wall does.
SurfaceTruth TruthOf(const WallTruth& wall, SurfaceId id) {
  const auto found = wall.surfaces.find(id);
  return found != wall.surfaces.end() ? found->second : SurfaceTruth{wall.translation_m, wall.rotation_deg};
}

WallResult Reported(const SurfaceEntry& s, WallOutcome outcome, const SurfaceTruth& truth) {
  WallResult r;
  r.guid = s.wall_guid;
  r.outcome = outcome;
  r.surface = s.id;
  r.true_translation_m = truth.translation_m;
  r.true_rotation_deg = truth.rotation_deg;
  r.measured_translation_m = s.translation_m;
  r.measured_rotation_deg = s.rotation_deg;
  r.sigma_translation_m = s.sigma_translation_m;
  r.error_translation_m = std::abs(s.translation_m - truth.translation_m);
  r.error_rotation_deg = std::abs(s.rotation_deg - truth.rotation_deg);
  return r;
}

WallResult ResultOf(const WallTruth& wall, const std::vector<const SurfaceEntry*>& surfaces, const Truth& truth, double min_points) {
  WallResult worst;
  worst.guid = wall.guid;
  worst.true_translation_m = wall.translation_m;
  worst.true_rotation_deg = wall.rotation_deg;
  const bool judged = std::any_of(surfaces.begin(), surfaces.end(), [](const SurfaceEntry* s) { return s->status != "unobserved"; });
  const WallOutcome seen = judged ? WallOutcome::kMissed : WallOutcome::kUnjudged;
  worst.outcome = Observed(surfaces, truth, min_points) ? seen : WallOutcome::kUnobserved;
  for (const SurfaceEntry* s : surfaces) {
    if (!ReportedOff(*s)) continue;
    WallResult r = Reported(*s, WallOutcome::kFound, TruthOf(wall, s->id));
    if (r.error_translation_m > std::max(kAccurate_m, kAccurateSigmas * r.sigma_translation_m)) r.outcome = WallOutcome::kInaccurate;
    if (!worst.measured() || r.error_translation_m > worst.error_translation_m) worst = r;
  }
  return worst;
}

}  // namespace

const char* WallOutcomeName(WallOutcome outcome) {
  switch (outcome) {
    case WallOutcome::kFound: return "found";
    case WallOutcome::kInaccurate: return "inaccurate";
    case WallOutcome::kMissed: return "missed";
    case WallOutcome::kUnjudged: return "unjudged";
    case WallOutcome::kUnobserved: return "unobserved";
    case WallOutcome::kFalse: return "false";
  }
  return "missed";
}

std::vector<WallResult> CompareWalls(const Truth& truth, const Deviations& reported, double min_points) {
  SurfacesOfWall surfaces;
  for (const SurfaceEntry& s : reported.surfaces) surfaces[s.wall_guid].push_back(&s);
  std::vector<WallResult> results;
  for (const WallTruth& wall : truth.walls) {
    if (wall.deviates()) results.push_back(ResultOf(wall, surfaces[wall.guid], truth, min_points));
    if (wall.deviates()) surfaces.erase(wall.guid);
  }
  for (const auto& [guid, entries] : surfaces) {
    const SurfaceEntry* worst = nullptr;
    for (const SurfaceEntry* s : entries) {
      if (ReportedOff(*s) && (!worst || std::abs(s->translation_m) > std::abs(worst->translation_m))) worst = s;
    }
    if (!worst) continue;
    WallResult r = Reported(*worst, WallOutcome::kFalse, {});
    r.error_translation_m = r.error_rotation_deg = 0;
    results.push_back(r);
  }
  std::sort(results.begin(), results.end(),
            [](const WallResult& a, const WallResult& b) { return std::tie(a.outcome, a.guid) < std::tie(b.outcome, b.guid); });
  return results;
}

}  // namespace plumb::tools
