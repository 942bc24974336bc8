#include "runtime/coupling/level_matching.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "schema/polygon.h"

namespace plumb::runtime {
namespace {

struct LevelMatch {
  Match match;
  double points = 0;
};

class LevelMatcher {
 public:
  LevelMatcher(const SGraph& map, const AGraph& plan, const Eigen::Isometry3d& T_plan_map)
      : map_(map), plan_(plan), T_plan_map_(T_plan_map) {}

  // The room whose level, `height_m` higher than planned, most of the surface's points are within `gate_m` of. None for walls.
  [[nodiscard]] std::optional<LevelMatch> Find(uint32_t i, double height_m, double gate_m) const {
    const MapSurface& surface = map_.surfaces[i];
    if (surface.kind == SurfaceKind::kWall || surface.observations.empty()) return std::nullopt;
    std::vector<double> votes(plan_.rooms.size(), 0), offsets(plan_.rooms.size(), 0);
    for (const Observation& o : surface.observations) {
      const Eigen::Vector3d p = T_plan_map_ * (map_.keyframes[o.keyframe].T_map_kf * o.stats.centroid());
      for (size_t r = 0; r < plan_.rooms.size(); ++r) {
        const Room& room = plan_.rooms[r];
        const double offset_m = p.z() - (surface.kind == SurfaceKind::kFloor ? room.floor_z_m : room.ceiling_z_m);
        if (std::abs(offset_m - height_m) > gate_m || !Contains(room, p.head<2>())) continue;
        votes[r] += o.stats.count();
        offsets[r] += o.stats.count() * offset_m;
      }
    }
    const auto best = std::max_element(votes.begin(), votes.end());
    if (best == votes.end() || *best <= 0) return std::nullopt;
    const auto room = static_cast<size_t>(best - votes.begin());
    return LevelMatch{{i, SurfaceId(), RoomId(room), offsets[room] / *best, 0, {}}, *best};
  }

  [[nodiscard]] std::vector<Match> FindAll(double height_m, double gate_m) const {
    std::vector<Match> matches;
    for (uint32_t i = 0; i < map_.surfaces.size(); ++i) {
      if (auto found = Find(i, height_m, gate_m)) matches.push_back(std::move(found->match));
    }
    return matches;
  }

  // By how much the floor that is seen best lies higher than planned.
  [[nodiscard]] std::optional<double> HeightOfBestFloor(double gate_m) const {
    std::optional<LevelMatch> best;
    for (uint32_t i = 0; i < map_.surfaces.size(); ++i) {
      if (!IsFloor(i)) continue;
      auto found = Find(i, 0, gate_m);
      if (found && (!best || found->points > best->points)) best = std::move(found);
    }
    return best ? std::optional(best->match.offset_m) : std::nullopt;
  }

  [[nodiscard]] bool IsFloor(uint32_t i) const { return map_.surfaces[i].kind == SurfaceKind::kFloor; }

 private:
  const SGraph& map_;
  const AGraph& plan_;
  const Eigen::Isometry3d& T_plan_map_;
};

}  // namespace

std::vector<Match> MatchLevels(const SGraph& map, const AGraph& plan, const Eigen::Isometry3d& T_plan_map, const CouplingOptions& options) {
  const LevelMatcher matcher(map, plan, T_plan_map);
  std::vector<Match> matches = matcher.FindAll(0, options.max_level_offset_m);
  if (std::any_of(matches.begin(), matches.end(), [&](const Match& m) { return matcher.IsFloor(m.map_surface); })) return matches;
  const std::optional<double> height_m = matcher.HeightOfBestFloor(options.max_unknown_height_m);
  return height_m ? matcher.FindAll(*height_m, options.max_level_offset_m) : matches;
}

}  // namespace plumb::runtime
