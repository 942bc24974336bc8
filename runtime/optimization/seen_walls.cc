#include "runtime/optimization/seen_walls.h"

#include <algorithm>
#include <map>
#include <utility>

namespace plumb::runtime {
namespace {

constexpr double kSameSide = 0.9;  // cosine between normals of faces of one side of a wall

// Of the points of a match's patch, those that say something of its wall.
double ShareThatCounts(const SGraph& map, const Match& m) {
  const std::vector<Observation>& observations = map.surfaces[m.map_surface].observations;
  double counts = 0, all = 0;
  for (size_t i = 0; i < observations.size(); ++i) {
    all += observations[i].stats.count();
    if (!m.IsMistaken(i)) counts += observations[i].stats.count();
  }
  return all > 0 ? counts / all : 0;
}

// Rooms divide one side of a wall into several faces: how much of a match's patch lies on each. What goes on beyond the wall is no part of
// it, so the shares add up to one at most.
std::vector<std::pair<SurfaceId, double>> SharesOfFaces(const SGraph& map, const AGraph& plan, const Match& m,
                                                        const Eigen::Isometry3d& T_plan_map) {
  const Surface& matched = plan.surfaces[m.plan_surface.index()];
  if (matched.arc) return {{m.plan_surface, 1.0}};
  const MapSurface& patch = map.surfaces[m.map_surface];
  const Eigen::Vector2d along = (matched.end - matched.start).normalized();
  const auto u = [&](const Eigen::Vector2d& at) { return along.dot((T_plan_map * Eigen::Vector3d(at.x(), at.y(), 0)).head<2>()); };
  const double start = u(patch.start), end = u(patch.end), length_m = patch.length_m();
  const auto share_between = [&](double from, double to) {
    if (patch.cells.empty()) {
      const auto [low, high] = std::minmax({start, end});
      return high > low ? std::max(0.0, std::min(to, high) - std::max(from, low)) / (high - low) : 0.0;
    }
    const auto on_face = std::count_if(patch.cells.begin(), patch.cells.end(), [&](const Eigen::Vector2f& cell) {
      const double at = start + cell.x() / length_m * (end - start);
      return at >= from && at <= to;
    });
    return static_cast<double>(on_face) / static_cast<double>(patch.cells.size());
  };
  std::vector<std::pair<SurfaceId, double>> shares;
  double sum = 0;
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    const Surface& face = plan.surfaces[i];
    if (face.wall != matched.wall || face.storey != matched.storey || face.arc || face.normal.dot(matched.normal) < kSameSide) continue;
    const auto [from, to] = std::minmax({along.dot(face.start), along.dot(face.end)});
    const double share = share_between(from, to);
    if (share > 0) shares.emplace_back(SurfaceId(i), share);
    sum += share;
  }
  for (auto& [face, share] : shares) share /= std::max(1.0, sum);  // faces of two rooms may lie one above the other
  return shares;
}

// From where to where along its wall the match's patch reaches, within the face: it may go on along the next wall.
void AddSpan(const SGraph& map, const AGraph& plan, const std::vector<WallFrame>& frames, const Match& m,
             const Eigen::Isometry3d& T_plan_map, std::map<WallId, std::pair<double, double>>& spans) {
  const MapSurface& patch = map.surfaces[m.map_surface];
  const WallId wall = plan.surfaces[m.plan_surface.index()].wall;
  const WallFrame& frame = frames[wall.index()];
  auto& [from, to] = spans.try_emplace(wall, 1e300, -1e300).first->second;
  const Surface& face = plan.surfaces[m.plan_surface.index()];
  const auto along = [&](const Eigen::Vector2d& at) {
    return (at - frame.pivot.head<2>()).dot(Eigen::Vector2d(-frame.normal.y(), frame.normal.x()));
  };
  const auto [face_from, face_to] = std::minmax({along(face.start), along(face.end)});
  for (const Eigen::Vector2d& end : {patch.start, patch.end}) {
    const double u = std::clamp(along((T_plan_map * Eigen::Vector3d(end.x(), end.y(), 0)).head<2>()), face_from, face_to);
    from = std::min(from, u);
    to = std::max(to, u);
  }
}

}  // namespace

void CountSeen(const SGraph& map, const AGraph& plan, const std::vector<WallFrame>& frames, const std::vector<Match>& matches,
               const Eigen::Isometry3d& T_plan_map, std::vector<WallEstimate>& walls) {
  std::map<SurfaceId, SeenSurface> seen;
  std::map<WallId, std::pair<double, double>> spans;
  for (const Match& m : matches) {
    if (!m.plan_surface.valid()) continue;
    const double counts = m.mistaken.empty() ? 1.0 : ShareThatCounts(map, m);
    for (const auto& [face, share] : SharesOfFaces(map, plan, m, T_plan_map)) {
      SeenSurface& s = seen[face];
      s.surface = face;
      s.num_points += counts * share * map.surfaces[m.map_surface].num_points;
      s.observed_m2 += counts * share * map.surfaces[m.map_surface].area_m2;
    }
    AddSpan(map, plan, frames, m, T_plan_map, spans);
  }
  for (const auto& [id, s] : seen) {
    const WallId wall = plan.surfaces[id.index()].wall;
    WallEstimate& e = *std::lower_bound(walls.begin(), walls.end(), wall, [](const WallEstimate& a, WallId b) { return a.wall < b; });
    e.seen.push_back(s);
    e.num_points += s.num_points;
    e.observed_m2 += s.observed_m2;
    e.span_m = spans[wall].second - spans[wall].first;
  }
}

}  // namespace plumb::runtime
