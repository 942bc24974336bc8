#include "runtime/optimization/level_votes.h"

#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace plumb::runtime {

std::vector<LevelVote> LevelVotes(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches,
                                  const std::vector<Eigen::Isometry3d>& T_map_kf, const Eigen::Isometry3d& T_plan_map) {
  std::vector<LevelVote> votes;
  std::map<std::pair<RoomId, SurfaceKind>, double> totals;
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
    for (const Observation& o : surface.observations) {
      const Eigen::Vector3d p = T_plan_map * (T_map_kf[o.keyframe] * o.stats.centroid());
      vote.error_m += o.stats.count() * (p.z() - vote.planned_z_m);
      count += o.stats.count();
    }
    if (!(count > 0)) continue;
    vote.error_m /= count;
    vote.share = count;
    totals[{match.room, surface.kind}] += count;
    votes.push_back(vote);
  }
  for (LevelVote& vote : votes) {
    const Match& match = matches[vote.match];
    vote.share /= totals[{match.room, map.surfaces[match.map_surface].kind}];
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
