#include "runtime/optimization/level_votes.h"

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "schema/polygon.h"

namespace plumb::runtime {
namespace {

constexpr double kSameLevel_m = 0.25;  // of rooms that one floor goes on through

using PointsOfRooms = std::map<size_t, double>;

// The room that has a floor (ceiling) about there.
std::optional<size_t> RoomAt(const AGraph& plan, const Eigen::Vector2d& p, SurfaceKind kind, double z_m) {
  for (size_t r = 0; r < plan.rooms.size(); ++r) {
    const Room& room = plan.rooms[r];
    const double planned_z_m = kind == SurfaceKind::kFloor ? room.floor_z_m : room.ceiling_z_m;
    if (std::abs(planned_z_m - z_m) < kSameLevel_m && Contains(room, p)) return r;
  }
  return std::nullopt;
}

}  // namespace

std::vector<LevelVote> LevelVotes(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches,
                                  const std::vector<Eigen::Isometry3d>& T_map_kf, const Eigen::Isometry3d& T_plan_map) {
  std::vector<LevelVote> votes;
  std::vector<PointsOfRooms> points;  // of each vote
  std::map<std::pair<size_t, SurfaceKind>, double> totals;
  for (size_t i = 0; i < matches.size(); ++i) {
    const Match& match = matches[i];
    if (match.plan_surface.valid()) continue;
    const MapSurface& surface = map.surfaces[match.map_surface];
    const Room& room = plan.rooms[match.room.index()];
    LevelVote vote;
    vote.match = i;
    vote.floor = surface.kind == SurfaceKind::kFloor;
    vote.planned_z_m = vote.floor ? room.floor_z_m : room.ceiling_z_m;
    double count = 0;
    PointsOfRooms of_rooms;
    for (const Observation& o : surface.observations) {
      const Eigen::Vector3d p = T_plan_map * (T_map_kf[o.keyframe] * o.stats.centroid());
      vote.error_m += o.stats.count() * (p.z() - vote.planned_z_m);
      count += o.stats.count();
      of_rooms[RoomAt(plan, p.head<2>(), surface.kind, vote.planned_z_m).value_or(match.room.index())] += o.stats.count();
    }
    if (!(count > 0)) continue;
    vote.error_m /= count;
    votes.push_back(vote);
    for (const auto& [of_room, n] : of_rooms) totals[{of_room, surface.kind}] += n;
    points.push_back(std::move(of_rooms));
  }
  for (size_t v = 0; v < votes.size(); ++v) {
    const SurfaceKind kind = map.surfaces[matches[votes[v].match].map_surface].kind;
    votes[v].share = 0;
    for (const auto& [room, n] : points[v]) {
      if (n > 0) votes[v].share += n / totals[{room, kind}];
    }
  }
  return votes;
}

double ConsensusHeight(const std::vector<LevelVote>& votes, double sigma_m) {
  const auto cost = [&](double height_m) {
    double sum = 0;
    for (const LevelVote& v : votes) {
      const double scale = v.floor ? kFloorLoss : kCeilingLoss, e = (v.error_m - height_m) / (scale * sigma_m);
      sum += v.share * scale * scale * std::log1p(e * e);
    }
    return sum;
  };
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (const LevelVote& v : votes) {
    const double c = cost(v.error_m);
    if (c >= least) continue;
    least = c;
    best = v.error_m;
  }
  return best;
}

}  // namespace plumb::runtime
