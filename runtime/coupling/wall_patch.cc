#include "runtime/coupling/wall_patch.h"

#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr double kMaxPassedRatio = 0.2;    // a wall stops all lines of sight but so many ...
constexpr size_t kMinPassed = 5;           // ... and so few
constexpr double kMinSingleArea_m2 = 0.6;  // a smaller patch seen from one keyframe only is too rough to tell
constexpr double kExplainMargin_m = 0.2, kExplainMarginRatio = 0.25;  // about a face's edges, and of its length

}  // namespace

std::vector<Patch> WallPatches(const SGraph& map, const Eigen::Isometry3d& T_plan_map) {
  std::vector<Patch> patches;
  for (size_t i = 0; i < map.surfaces.size(); ++i) {
    const MapSurface& s = map.surfaces[i];
    if (s.kind != SurfaceKind::kWall || s.observations.empty()) continue;
    if (s.observations.size() < 2 && s.area_m2 < kMinSingleArea_m2) continue;
    const Eigen::Vector3d start = T_plan_map * Eigen::Vector3d(s.start.x(), s.start.y(), s.z_min_m);
    const Eigen::Vector3d end = T_plan_map * Eigen::Vector3d(s.end.x(), s.end.y(), s.z_max_m);
    patches.push_back({static_cast<uint32_t>(i), s.observations.size(), start.head<2>(), end.head<2>(), T_plan_map.linear() * s.plane.n,
                       start.z(), end.z(), T_plan_map.translation().z(), s.area_m2, &s.cells});
  }
  return patches;
}

double OverlapRatio(double a0, double a1, double b0, double b1) {
  const double shorter = std::min(a1 - a0, b1 - b0);
  return shorter > 0 ? (std::min(a1, b1) - std::max(a0, b0)) / shorter : 0.0;
}

double OpenRatio(const Patch& patch, const std::vector<WallOpening>& openings, const Eigen::Vector2d& along, bool recessed) {
  if (patch.cells->empty() || openings.empty()) return 0;
  const double margin_m = recessed ? kOpeningMargin_m : 0.0;
  const double from = along.dot(patch.start), per_metre = along.dot(patch.end - patch.start) / patch.length();
  size_t open = 0;
  for (const Eigen::Vector2f& cell : *patch.cells) {
    open += InOpening(openings, along, from + per_metre * cell.x(), cell.y() + patch.z_shift, margin_m) ? 1 : 0;
  }
  return static_cast<double>(open) / static_cast<double>(patch.cells->size());
}

double ExplainedRatio(const Patch& patch, const Surface& surface) {
  const Eigen::Vector2d along = (surface.end - surface.start).normalized();
  const double from = along.dot(patch.start - surface.start), per_metre = along.dot(patch.end - patch.start) / patch.length();
  const double margin_m = std::min(kExplainMargin_m, kExplainMarginRatio * surface.length_m());
  if (patch.cells->empty()) {
    const double to = from + per_metre * patch.length();
    return std::max(0.0, std::min(surface.length_m(), std::max(from, to)) - std::max(0.0, std::min(from, to))) / patch.length();
  }
  const auto num = std::count_if(patch.cells->begin(), patch.cells->end(), [&](const Eigen::Vector2f& c) {
    return std::abs(from + per_metre * c.x() - 0.5 * surface.length_m()) < 0.5 * surface.length_m() + margin_m;
  });
  return static_cast<double>(num) / static_cast<double>(patch.cells->size());
}

bool IsSeenThrough(const Patch& patch, const Surface& surface, const std::vector<WallOpening>& openings, const SightLines& sight) {
  const SightLines::Count count = sight.Meeting({patch.midpoint(), patch.normal.head<2>().normalized(), &surface, &openings});
  return static_cast<double>(count.passed) > kMaxPassedRatio * static_cast<double>(count.ended + count.passed) && count.passed > kMinPassed;
}

}  // namespace plumb::runtime
