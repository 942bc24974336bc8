#include "runtime/deviations/planned_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/matching/ray_caster.h"

namespace plumb::runtime {
namespace {

constexpr double kProbe_m = 0.15;        // triangles are looked for this far before and behind what was seen
constexpr double kOnTriangle_m = 0.015;  // what was seen lies on a triangle within this
constexpr double kMuchNearer = 0.5;      // than the face: a wall that is off its plan is off both alike
constexpr double kMinHit = 0.7;          // share of a part's cells that have a triangle near
constexpr double kMinExplained = 0.7;    // share of the area
constexpr size_t kParts = 3, kMinCells = 4;
constexpr size_t kMaxCells = 300;  // of one surface: enough to tell
constexpr double kPastTriangle_m = 1e-3;
constexpr int kMaxTriangles = 8;  // about one place

struct Part {
  std::vector<double> to_triangles, to_face;  // signed distances of what was seen, of each cell; kProbe_m: no triangle is near
};

double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Signed distance of what was seen at p to the nearest triangle along its normal n; kProbe_m: none is near. A wall that moved away hides
// nothing of what stood behind or against it, so of its own triangles only the foremost counts.
double ToTriangles_m(const AGraph& plan, const RayCaster& caster, WallId wall, const Eigen::Vector3d& p, const Eigen::Vector3d& n) {
  double nearest_m = kProbe_m, from_m = -kProbe_m;
  for (int i = 0; i < kMaxTriangles && from_m < kProbe_m; ++i) {
    Ray ray;
    ray.origin = (p - from_m * n - plan.origin).cast<float>();
    ray.direction = -n.cast<float>();
    ray.max_range_m = static_cast<float>(kProbe_m - from_m);
    const RayHit hit = caster.Cast(ray);
    if (!hit.hit()) break;
    const double at_m = from_m + static_cast<double>(hit.range_m);
    const bool of_wall = plan.elements[plan.mesh.triangles[hit.triangle].element].wall == wall;
    if ((i == 0 || !of_wall) && std::abs(at_m) < std::abs(nearest_m)) nearest_m = at_m;
    from_m = at_m + kPastTriangle_m;
  }
  return nearest_m;
}

// Along the length of a map surface.
std::array<Part, kParts> PartsOf(const MapSurface& seen, const Surface& face, const Eigen::Isometry3d& T_plan_map, const AGraph& plan,
                                 const RayCaster& caster) {
  std::array<Part, kParts> out;
  const Eigen::Vector2d along = (seen.end - seen.start).normalized(), face_normal = face.normal.head<2>();
  const Eigen::Vector3d n = T_plan_map.linear() * seen.plane.n;
  const size_t step = 1 + seen.cells.size() / kMaxCells;
  for (size_t i = 0; i < seen.cells.size(); i += step) {
    const Eigen::Vector2d at = seen.start + static_cast<double>(seen.cells[i].x()) * along;
    Eigen::Vector3d p(at.x(), at.y(), static_cast<double>(seen.cells[i].y()));
    p = T_plan_map * (p - (seen.plane.n.dot(p) + seen.plane.d) * seen.plane.n);
    const double share = static_cast<double>(seen.cells[i].x()) / std::max(seen.length_m(), 1e-9);
    Part& part = out[static_cast<size_t>(std::clamp(share * kParts, 0.0, static_cast<double>(kParts - 1)))];
    part.to_triangles.push_back(ToTriangles_m(plan, caster, face.wall, p, n));
    part.to_face.push_back(face_normal.dot(p.head<2>() - face.start));
  }
  return out;
}

bool LiesOnPlan(const MapSurface& seen, const Surface& face, const Eigen::Isometry3d& T_plan_map, const AGraph& plan,
                const RayCaster& caster) {
  double off_triangles_m = -1, off_face_m = 0;
  for (Part& part : PartsOf(seen, face, T_plan_map, plan, caster)) {
    if (part.to_face.size() < kMinCells) continue;
    const auto hits = std::count_if(part.to_triangles.begin(), part.to_triangles.end(), [](double d) { return d < kProbe_m; });
    if (static_cast<double>(hits) < kMinHit * static_cast<double>(part.to_face.size())) return false;
    off_triangles_m = std::max(off_triangles_m, std::abs(Median(part.to_triangles)));
    off_face_m = std::max(off_face_m, std::abs(Median(part.to_face)));
  }
  return off_triangles_m >= 0 && off_triangles_m <= kOnTriangle_m && off_triangles_m < kMuchNearer * off_face_m;
}

}  // namespace

std::vector<bool> MatchesOnOtherShapes(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches,
                                       const JointResult& estimate) {
  const RayCaster caster(plan.mesh);
  std::vector<bool> out;
  for (const Match& match : matches) {
    const bool of_wall = match.plan_surface.valid() && plan.surfaces[match.plan_surface.index()].wall.valid();
    out.push_back(of_wall && LiesOnPlan(map.surfaces[match.map_surface], plan.surfaces[match.plan_surface.index()], estimate.T_plan_map,
                                        plan, caster));
  }
  return out;
}

std::vector<bool> LieOnOtherShapes(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches, const JointResult& estimate) {
  std::vector<double> seen_m2(plan.walls.size(), 0), explained_m2(plan.walls.size(), 0);
  const std::vector<bool> on_other_shape = MatchesOnOtherShapes(map, plan, matches, estimate);
  for (size_t i = 0; i < matches.size(); ++i) {
    if (!matches[i].plan_surface.valid()) continue;
    const WallId wall = plan.surfaces[matches[i].plan_surface.index()].wall;
    if (!wall.valid()) continue;
    const double area_m2 = map.surfaces[matches[i].map_surface].area_m2;
    seen_m2[wall.index()] += area_m2;
    if (on_other_shape[i]) explained_m2[wall.index()] += area_m2;
  }
  std::vector<bool> out;
  for (size_t w = 0; w < plan.walls.size(); ++w) out.push_back(seen_m2[w] > 0 && explained_m2[w] >= kMinExplained * seen_m2[w]);
  return out;
}

}  // namespace plumb::runtime
