#include "tools/evaluate/wall_results.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace plumb::tools {
namespace {

using Surfaces = std::vector<const SurfaceEntry*>;

constexpr double kAccurate_m = 0.04, kAccurateSigmas = 2;

bool ReportedOff(const SurfaceEntry& s) { return s.status == "deviated"; }

// What counts as observed.
struct Enough {
  double points, seen_m2;
};

bool Observed(const Surfaces& surfaces, const Truth& truth, const Enough& enough) {
  return std::any_of(surfaces.begin(), surfaces.end(), [&](const SurfaceEntry* s) {
    if (truth.surface_points.empty()) return s->status != "unobserved";
    const auto hits = truth.surface_points.find(s->id);
    if (hits == truth.surface_points.end() || hits->second < enough.points) return false;
    const auto seen = truth.surface_seen_m2.find(s->id);
    return truth.surface_seen_m2.empty() || (seen != truth.surface_seen_m2.end() && seen->second >= enough.seen_m2);
  });
}

// What surface `id` of the wall really does; surfaces that truth.json does not list move as the wall does.
SurfaceTruth TruthOf(const WallTruth& wall, SurfaceId id) {
  const auto found = wall.surfaces.find(id);
  return found != wall.surfaces.end() ? found->second : SurfaceTruth{wall.translation_m, wall.rotation_deg};
}

// Of the surfaces that are reported to deviate those that were observed, or all if none was: what was not seen is told by the other side.
Surfaces Deviating(const Surfaces& surfaces) {
  Surfaces all, observed;
  for (const SurfaceEntry* s : surfaces) {
    if (!ReportedOff(*s)) continue;
    all.push_back(s);
    if (s->points > 0) observed.push_back(s);
  }
  return observed.empty() ? all : observed;
}

WallResult Reported(const SurfaceEntry& s, WallOutcome outcome, const SurfaceTruth& truth) {
  WallResult r;
  r.wall = s.wall;
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

WallResult ResultOf(const WallTruth& wall, const Surfaces& surfaces, const Truth& truth, const Enough& enough) {
  WallResult worst;
  worst.wall = wall.wall;
  worst.guid = wall.guid;
  worst.name = wall.name;
  worst.true_translation_m = wall.translation_m;
  worst.true_rotation_deg = wall.rotation_deg;
  const bool judged = std::any_of(surfaces.begin(), surfaces.end(), [](const SurfaceEntry* s) { return s->status != "unobserved"; });
  const WallOutcome seen = judged ? WallOutcome::kMissed : WallOutcome::kUnjudged;
  worst.outcome = Observed(surfaces, truth, enough) ? seen : WallOutcome::kUnobserved;
  for (const SurfaceEntry* s : Deviating(surfaces)) {
    WallResult r = Reported(*s, WallOutcome::kFound, TruthOf(wall, s->id));
    r.wall = wall.wall;
    r.name = wall.name;
    if (r.error_translation_m > std::max(kAccurate_m, kAccurateSigmas * r.sigma_translation_m)) r.outcome = WallOutcome::kInaccurate;
    if (!worst.measured() || r.error_translation_m > worst.error_translation_m) worst = r;
  }
  return worst;
}

// Takes those out of `surfaces` for which it holds.
template <class Predicate>
Surfaces TakeIf(Surfaces& surfaces, Predicate holds) {
  Surfaces taken;
  std::erase_if(surfaces, [&](const SurfaceEntry* s) {
    if (holds(*s)) taken.push_back(s);
    return holds(*s);
  });
  return taken;
}

// Of walls that stand as planned: the largest report, if there is one.
std::optional<WallResult> FalseReport(const Surfaces& surfaces, const Truth& truth) {
  const SurfaceEntry* worst = nullptr;
  for (const SurfaceEntry* s : Deviating(surfaces)) {
    if (!worst || std::abs(s->translation_m) > std::abs(worst->translation_m)) worst = s;
  }
  if (!worst) return std::nullopt;
  WallResult r = Reported(*worst, WallOutcome::kFalse, {});
  r.error_translation_m = r.error_rotation_deg = 0;
  const auto named =
      std::find_if(truth.walls.begin(), truth.walls.end(), [&](const WallTruth& w) { return IsOfWall(*worst, w.wall, w.guid); });
  if (named != truth.walls.end()) r.name = named->name;
  return r;
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

bool IsOfWall(const SurfaceEntry& surface, WallId wall, const std::string& guid) {
  if (surface.wall.valid() && wall.valid()) return surface.wall == wall;
  return !guid.empty() && surface.wall_guid == guid;
}

std::vector<WallResult> CompareWalls(const Truth& truth, const Deviations& reported, double min_points, double min_seen_m2) {
  Surfaces rest;
  for (const SurfaceEntry& s : reported.surfaces) rest.push_back(&s);
  std::vector<WallResult> results;
  for (const WallTruth& wall : truth.walls) {
    if (!wall.deviates()) continue;
    const Surfaces surfaces =
        TakeIf(rest, [&](const SurfaceEntry& s) { return wall.surfaces.contains(s.id) || IsOfWall(s, wall.wall, wall.guid); });
    results.push_back(ResultOf(wall, surfaces, truth, {min_points, min_seen_m2}));
  }
  while (!rest.empty()) {
    const SurfaceEntry first = *rest.front();
    const Surfaces entries =
        TakeIf(rest, [&](const SurfaceEntry& s) { return s.id == first.id || IsOfWall(s, first.wall, first.wall_guid); });
    if (const auto accused = FalseReport(entries, truth)) results.push_back(*accused);
  }
  std::sort(results.begin(), results.end(), [](const WallResult& a, const WallResult& b) {
    return std::tie(a.outcome, a.guid, a.wall) < std::tie(b.outcome, b.guid, b.wall);
  });
  return results;
}

}  // namespace plumb::tools
