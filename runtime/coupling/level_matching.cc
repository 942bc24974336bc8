#include "runtime/coupling/level_matching.h"

#include <algorithm>
#include <cmath>

#include "schema/polygon.h"

namespace plumb::runtime {
std::vector<Match> MatchLevels(const SGraph& map, const AGraph& plan, const Eigen::Isometry3d& T_plan_map, const CouplingOptions& options) {
  std::vector<Match> matches;
  for (size_t i = 0; i < map.surfaces.size(); ++i) {
    const MapSurface& surface = map.surfaces[i];
    if (surface.kind == SurfaceKind::kWall || surface.observations.empty()) continue;
    std::vector<double> votes(plan.rooms.size(), 0), offsets(plan.rooms.size(), 0);
    for (const Observation& o : surface.observations) {
      const Eigen::Vector3d p = T_plan_map * (map.keyframes[o.keyframe].T_map_kf * o.stats.centroid());
      for (size_t r = 0; r < plan.rooms.size(); ++r) {
        const double offset = p.z() - (surface.kind == SurfaceKind::kFloor ? plan.rooms[r].floor_z_m : plan.rooms[r].ceiling_z_m);
        if (std::abs(offset) > options.max_level_offset_m || !Contains(plan.rooms[r], p.head<2>())) continue;
        votes[r] += o.stats.count();
        offsets[r] += o.stats.count() * offset;
      }
    }
    const auto best = std::max_element(votes.begin(), votes.end());
    if (best == votes.end() || *best <= 0) continue;
    const auto room = static_cast<size_t>(best - votes.begin());
    matches.push_back({static_cast<uint32_t>(i), SurfaceId(), RoomId(room), offsets[room] / *best, 0, {}});
  }
  return matches;
}

}  // namespace plumb::runtime
