#include "runtime/deviations/planned_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/matching/ray_caster.h"

namespace plumb::runtime {
namespace {

constexpr double kProbe_m = 0.15;          // triangles are looked for this far before and behind what was seen
constexpr double kOnTriangle_m = 0.015;    // half of the smallest deviation worth finding
constexpr double kMinHit = 0.7;            // share of a part's cells that have a triangle near
constexpr double kMinExplained = 0.7;      // share of the area
constexpr size_t kParts = 3, kMinCells = 4;
constexpr size_t kMaxCells = 300;          // of one surface: enough to tell

// Signed distances from what was seen to the plan's triangles, of the parts of a map surface along its length.
std::array<std::vector<double>, kParts> DistancesToPlan(const MapSurface& seen, const Eigen::Isometry3d& T_plan_map,
                                                        const RayCaster& caster, const Eigen::Vector3d& origin) {
  std::array<std::vector<double>, kParts> out;
  const Eigen::Vector2d along = (seen.end - seen.start).normalized();
  const Eigen::Vector3d n = T_plan_map.linear() * seen.plane.n;
  const size_t step = 1 + seen.cells.size() / kMaxCells;
  for (size_t i = 0; i < seen.cells.size(); i += step) {
    const Eigen::Vector2d at = seen.start + static_cast<double>(seen.cells[i].x()) * along;
    Eigen::Vector3d p(at.x(), at.y(), static_cast<double>(seen.cells[i].y()));
    p -= (seen.plane.n.dot(p) + seen.plane.d) * seen.plane.n;
    Ray ray;
    ray.origin = (T_plan_map * p + kProbe_m * n - origin).cast<float>();
    ray.direction = -n.cast<float>();
    ray.max_range_m = static_cast<float>(2 * kProbe_m);
    const RayHit hit = caster.Cast(ray);
    const double share = static_cast<double>(seen.cells[i].x()) / std::max(seen.length_m(), 1e-9);
    const auto part = static_cast<size_t>(std::clamp(share * kParts, 0.0, static_cast<double>(kParts - 1)));
    out[part].push_back(hit.hit() ? static_cast<double>(hit.range_m) - kProbe_m : kProbe_m);
  }
  return out;
}

bool LiesOnPlan(const MapSurface& seen, const Eigen::Isometry3d& T_plan_map, const RayCaster& caster, const Eigen::Vector3d& origin) {
  size_t judged = 0;
  for (std::vector<double>& part : DistancesToPlan(seen, T_plan_map, caster, origin)) {
    if (part.size() < kMinCells) continue;
    ++judged;
    const auto hits = std::count_if(part.begin(), part.end(), [](double d) { return d < kProbe_m; });
    if (static_cast<double>(hits) < kMinHit * static_cast<double>(part.size())) return false;
    std::nth_element(part.begin(), part.begin() + static_cast<ptrdiff_t>(part.size() / 2), part.end());
    if (std::abs(part[part.size() / 2]) > kOnTriangle_m) return false;
  }
  return judged > 0;
}

}  // namespace

std::vector<bool> ShapesAsPlanned(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches, const JointResult& estimate) {
  std::vector<double> seen_m2(plan.walls.size(), 0), explained_m2(plan.walls.size(), 0);
  const RayCaster caster(plan.mesh);
  for (const Match& match : matches) {
    if (!match.plan_surface.valid()) continue;
    const WallId wall = plan.surfaces[match.plan_surface.index()].wall;
    if (!wall.valid()) continue;
    const MapSurface& seen = map.surfaces[match.map_surface];
    seen_m2[wall.index()] += seen.area_m2;
    if (LiesOnPlan(seen, estimate.T_plan_map, caster, plan.origin)) explained_m2[wall.index()] += seen.area_m2;
  }
  std::vector<bool> out;
  for (size_t w = 0; w < plan.walls.size(); ++w) out.push_back(seen_m2[w] > 0 && explained_m2[w] >= kMinExplained * seen_m2[w]);
  return out;
}

}  // namespace plumb::runtime
