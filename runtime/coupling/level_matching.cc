#include "runtime/coupling/level_matching.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "schema/polygon.h"

namespace plumb::runtime {
namespace {

constexpr double kKnownHeightWeight = 2;  // what another height must have more of than the one that levels are matched at
constexpr double kReflections = 0.3;      // of a floor's points may lie below it
constexpr double kStep_m = 0.12;          // what is so much lower is no unevenness of the same floor

// Points of a floor or ceiling in a room.
struct LevelPoints {
  size_t room;
  double offset_m;  // by how much they lie higher than the room's level
  double count;
};

// All that faces upwards in one room, by height.
class Profile {
 public:
  void Add(double offset_m, double count) { steps_.emplace_back(offset_m, count); }
  void Close() {
    std::sort(steps_.begin(), steps_.end());
    double sum = 0;
    for (auto& [offset_m, count] : steps_) count = sum += count;
  }
  // How many points lie lower.
  [[nodiscard]] double Below(double offset_m) const {
    const auto at = std::lower_bound(steps_.begin(), steps_.end(), std::pair(offset_m, 0.0));
    return at == steps_.begin() ? 0 : std::prev(at)->second;
  }

 private:
  std::vector<std::pair<double, double>> steps_;  // once closed: an offset, and how many points are as high or lower
};

class LevelMatcher {
 public:
  // Only points within reach_m of a room's level are looked at.
  LevelMatcher(const SGraph& map, const AGraph& plan, const Eigen::Isometry3d& T_plan_map, double reach_m)
      : map_(map), rooms_(plan.rooms.size()), points_(map.surfaces.size()), profiles_(plan.rooms.size()) {
    for (uint32_t i = 0; i < map.surfaces.size(); ++i) {
      if (map.surfaces[i].kind == SurfaceKind::kWall) continue;
      for (const Observation& o : map.surfaces[i].observations) {
        const Eigen::Vector3d p = T_plan_map * (map.keyframes[o.keyframe].T_map_kf * o.stats.centroid());
        for (size_t r = 0; r < rooms_; ++r) {
          const Room& room = plan.rooms[r];
          const double offset_m = p.z() - (IsFloor(i) ? room.floor_z_m : room.ceiling_z_m);
          if (std::abs(offset_m) > reach_m || !Contains(room, p.head<2>())) continue;
          points_[i].push_back({r, offset_m, o.stats.count()});
          if (IsFloor(i)) profiles_[r].Add(offset_m, o.stats.count());
        }
      }
    }
    for (Profile& profile : profiles_) profile.Close();
  }

  // Each surface, but furniture, with the room whose level, `height_m` higher than planned, most of its points are within `gate_m` of.
  [[nodiscard]] std::vector<Match> FindAll(double height_m, double gate_m) const {
    std::vector<Match> matches;
    for (uint32_t i = 0; i < points_.size(); ++i) {
      auto found = Find(i, height_m, gate_m);
      if (!found || (IsFloor(i) && IsFurniture(*found))) continue;
      matches.push_back(std::move(*found));
    }
    return matches;
  }

  // How well the floors seen fit floors `height_m` higher than planned. Through a floor nothing is seen: where it would be, what lies lower
  // in the same room speaks against it.
  [[nodiscard]] double Support(double height_m, double gate_m) const {
    double support = 0;
    for (const Profile& profile : profiles_) {
      const double below = profile.Below(height_m - gate_m), on = profile.Below(height_m + gate_m) - below;
      if (below < kReflections * on) support += on;
    }
    return support;
  }

  // By how much the floors of the map lie higher than planned: zero if that fits them, else what fits them best.
  [[nodiscard]] double Height(double gate_m, double reach_m) const {
    double best_m = 0, best = kKnownHeightWeight * Support(0, gate_m);
    for (uint32_t i = 0; i < points_.size(); ++i) {
      if (!IsFloor(i)) continue;
      const auto match = Find(i, 0, reach_m);
      if (!match) continue;
      const double support = Support(match->offset_m, gate_m);
      if (support > best) {
        best = support;
        best_m = match->offset_m;
      }
    }
    return best_m;
  }

 private:
  [[nodiscard]] bool IsFloor(uint32_t i) const { return map_.surfaces[i].kind == SurfaceKind::kFloor; }

  [[nodiscard]] std::optional<Match> Find(uint32_t i, double height_m, double gate_m) const {
    std::vector<double> votes(rooms_, 0), offsets(rooms_, 0);
    for (const LevelPoints& p : points_[i]) {
      if (std::abs(p.offset_m - height_m) > gate_m) continue;
      votes[p.room] += p.count;
      offsets[p.room] += p.count * p.offset_m;
    }
    const auto best = std::max_element(votes.begin(), votes.end());
    if (best == votes.end() || *best <= 0) return std::nullopt;
    const auto room = static_cast<size_t>(best - votes.begin());
    return Match{i, SurfaceId(), RoomId(room), offsets[room] / *best, 0, {}};
  }

  // Something to sit on or to put things on: more than reflections lies lower in the same room. That may be of a floor that goes on through
  // other rooms, and is matched to one of those.
  [[nodiscard]] bool IsFurniture(const Match& floor) const {
    const Profile& profile = profiles_[floor.room.index()];
    const double low_m = floor.offset_m - kStep_m;
    double below = profile.Below(low_m);
    const double on = profile.Below(floor.offset_m + kStep_m) - below;
    for (const LevelPoints& p : points_[floor.map_surface]) {
      if (p.room == floor.room.index() && p.offset_m < low_m) below -= p.count;  // the low end of a ramp
    }
    return below >= kReflections * on;
  }

  const SGraph& map_;
  size_t rooms_;
  std::vector<std::vector<LevelPoints>> points_;  // of each surface; none of walls
  std::vector<Profile> profiles_;                 // of each room
};

}  // namespace

std::vector<Match> MatchLevels(const SGraph& map, const AGraph& plan, const Eigen::Isometry3d& T_plan_map, const CouplingOptions& options) {
  const double gate_m = options.max_level_offset_m, reach_m = options.max_unknown_height_m;
  const LevelMatcher matcher(map, plan, T_plan_map, reach_m + gate_m);
  return matcher.FindAll(matcher.Height(gate_m, reach_m), gate_m);
}

}  // namespace plumb::runtime
