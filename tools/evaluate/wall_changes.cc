#include "tools/evaluate/wall_changes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "schema/polygon.h"

namespace plumb::tools {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

constexpr double kNear_m = 0.10;
constexpr double kCovered = 0.5;
constexpr int kSamples = 50;

bool IsNear(const Eigen::Vector2d& p, const Polygon& polygon) { return DistanceToRing(polygon, p) <= kNear_m || Contains(polygon, p); }

// Points along the middle of the polygon, from the middle of its shortest side to that of the one that is farthest from it.
Polygon CentreLine(const Polygon& polygon) {
  const auto length = [&](size_t i) { return (polygon[(i + 1) % polygon.size()] - polygon[i]).norm(); };
  const auto middle = [&](size_t i) { return Eigen::Vector2d(0.5 * (polygon[i] + polygon[(i + 1) % polygon.size()])); };
  size_t first = 0, last = 0;
  for (size_t i = 1; i < polygon.size(); ++i) first = length(i) < length(first) ? i : first;
  for (size_t i = 1; i < polygon.size(); ++i) last = (middle(i) - middle(first)).norm() > (middle(last) - middle(first)).norm() ? i : last;
  Polygon points;
  for (int k = 0; k < kSamples; ++k) points.push_back(middle(first) + (k + 0.5) / kSamples * (middle(last) - middle(first)));
  return points;
}

// Share of the polygon's length that lies at one of the others.
double CoveredBy(const Polygon& polygon, const std::vector<Polygon>& others) {
  const Polygon points = CentreLine(polygon);
  const auto covered = std::count_if(points.begin(), points.end(), [&](const Eigen::Vector2d& p) {
    return std::any_of(others.begin(), others.end(), [&](const Polygon& other) { return IsNear(p, other); });
  });
  return static_cast<double>(covered) / static_cast<double>(points.size());
}

}  // namespace

std::vector<ChangeResult> CompareMissing(const Truth& truth, const Deviations& reported, double min_points, bool localized) {
  std::vector<const SurfaceEntry*> called_missing;
  for (const SurfaceEntry& s : reported.surfaces) {
    if (s.status == "missing") called_missing.push_back(&s);
  }
  const auto take = [&](WallId wall, const std::string& guid, SurfaceId alone) {
    return std::erase_if(called_missing,
                         [&](const SurfaceEntry* s) { return (alone.valid() && s->id == alone) || IsOfWall(*s, wall, guid); }) > 0;
  };
  std::vector<ChangeResult> results;
  for (const MissingTruth& wall : truth.missing) {
    const WallOutcome otherwise = localized && wall.rays_through >= min_points ? WallOutcome::kMissed : WallOutcome::kUnobserved;
    results.push_back({wall.guid, take(wall.wall, wall.guid, SurfaceId()) ? WallOutcome::kFound : otherwise, {}, wall.wall});
  }
  while (!called_missing.empty()) {
    const SurfaceEntry& s = *called_missing.front();
    results.push_back({s.wall_guid, WallOutcome::kFalse, {}, s.wall});
    take(s.wall, s.wall_guid, s.id);
  }
  std::sort(results.begin(), results.end(), [](const ChangeResult& a, const ChangeResult& b) {
    return std::tie(a.outcome, a.guid, a.wall) < std::tie(b.outcome, b.guid, b.wall);
  });
  return results;
}

std::vector<ChangeResult> CompareUnplanned(const Truth& truth, const Deviations& reported, double min_points, bool localized) {
  std::vector<Polygon> found, real;
  for (const UnplannedEntry& w : reported.unplanned) found.push_back(w.polygon);
  for (const UnplannedTruth& w : truth.unplanned) real.push_back(w.polygon);
  std::vector<ChangeResult> results;
  for (const UnplannedTruth& w : truth.unplanned) {
    const WallOutcome otherwise = localized && w.points >= min_points ? WallOutcome::kMissed : WallOutcome::kUnobserved;
    results.push_back({"", CoveredBy(w.polygon, found) >= kCovered ? WallOutcome::kFound : otherwise, w.polygon});
  }
  for (const Polygon& polygon : found) {
    if (CoveredBy(polygon, real) < kCovered) results.push_back({"", WallOutcome::kFalse, polygon});
  }
  return results;
}

size_t Count(const std::vector<ChangeResult>& results, WallOutcome outcome) {
  return static_cast<size_t>(std::count_if(results.begin(), results.end(), [&](const ChangeResult& r) { return r.outcome == outcome; }));
}

double Recall(const std::vector<ChangeResult>& results) {
  const size_t found = Count(results, WallOutcome::kFound), all = found + Count(results, WallOutcome::kMissed);
  return all == 0 ? 1 : static_cast<double>(found) / static_cast<double>(all);
}

double Precision(const std::vector<ChangeResult>& results) {
  const size_t found = Count(results, WallOutcome::kFound), all = found + Count(results, WallOutcome::kFalse);
  return all == 0 ? 1 : static_cast<double>(found) / static_cast<double>(all);
}

}  // namespace plumb::tools
