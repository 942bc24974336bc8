#include "runtime/matching/graph/wall_matching.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "runtime/matching/graph/densest_clique.h"

namespace plumb::runtime {
namespace {

constexpr size_t kMinWalls = 2;           // of a room, as in room_pairs
constexpr double kStartWeight = 1e-6;     // of where Align starts, against one wall
constexpr double kMinDeterminant = 0.05;  // of the normals' scatter per wall: 0 when all are parallel
constexpr double kMinOverlap_m = 0.4;     // of a wall without a room and the plan's

// Affinities of pairs of walls about two points that are taken to be the same.
class Comparison {
 public:
  Comparison(const MatchGraph& plan, const MatchGraph& map, const Eigen::Vector2d& origin_in_plan, const Eigen::Vector2d& origin_in_map)
      : plan_(plan), map_(map), origin_in_plan_(origin_in_plan), origin_in_map_(origin_in_map) {}
  // About a point of the map that `pose` puts into the plan.
  Comparison(const MatchGraph& plan, const MatchGraph& map, const PlanarPose& pose, const Eigen::Vector2d& origin_in_map)
      : Comparison(plan, map, pose.rotation() * origin_in_map + pose.t_m, origin_in_map) {}

  [[nodiscard]] double Affinity(const GraphWallPair& p, const GraphWallPair& q, const WallConsistency& bounds) const {
    return WallAffinity(InPlan(p), InPlan(q), InMap(p), InMap(q), bounds);
  }

  // The same for a wall that has moved: by its distances from parallel ones, and its angles.
  [[nodiscard]] double DeviatedAffinity(const GraphWallPair& p, const GraphWallPair& q, const WallConsistency& bounds) const {
    return WallAffinityUpToShift(InPlan(p), InPlan(q), InMap(p), InMap(q), bounds);
  }

  // Means over `others` but the pair itself.
  [[nodiscard]] double Mean(const GraphWallPair& pair, const std::vector<ScoredPair>& others, const WallConsistency& bounds) const {
    return MeanOf(pair, others, [&](const GraphWallPair& other) { return Affinity(pair, other, bounds); });
  }
  [[nodiscard]] double DeviatedMean(const GraphWallPair& pair, const std::vector<ScoredPair>& others, const WallConsistency& bounds) const {
    return MeanOf(pair, others, [&](const GraphWallPair& other) { return DeviatedAffinity(pair, other, bounds); });
  }
  [[nodiscard]] bool AgreesWithAll(const GraphWallPair& pair, const std::vector<ScoredPair>& others, const WallConsistency& bounds) const {
    return std::all_of(others.begin(), others.end(), [&](const ScoredPair& other) { return Affinity(pair, other.pair, bounds) > 0; });
  }

 private:
  template <class AffinityTo>
  [[nodiscard]] static double MeanOf(const GraphWallPair& pair, const std::vector<ScoredPair>& others, const AffinityTo& affinity) {
    double sum = 0;
    size_t count = 0;
    for (const ScoredPair& other : others) {
      if (other.pair == pair) continue;
      sum += affinity(other.pair);
      ++count;
    }
    return count > 0 ? sum / static_cast<double>(count) : 0;
  }

  [[nodiscard]] WallPoint InPlan(const GraphWallPair& p) const {
    return AboutOrigin(plan_.walls[p.plan].normal, plan_.walls[p.plan].d_m, origin_in_plan_);
  }
  [[nodiscard]] WallPoint InMap(const GraphWallPair& p) const {
    return AboutOrigin(map_.walls[p.map].normal, map_.walls[p.map].d_m, origin_in_map_);
  }

  const MatchGraph &plan_, &map_;
  const Eigen::Vector2d origin_in_plan_, origin_in_map_;
};

// A pair of walls and the rooms (positions in a list) that have it.
struct OwnedPair {
  GraphWallPair pair;
  std::vector<size_t> owners;
};

std::vector<OwnedPair> AllPairs(const std::vector<RoomPair>& rooms) {
  std::vector<OwnedPair> out;
  for (size_t r = 0; r < rooms.size(); ++r) {
    for (const std::vector<GraphWallPair>& group : rooms[r].groups) {
      for (const GraphWallPair& pair : group) {
        auto known = std::find_if(out.begin(), out.end(), [&](const OwnedPair& o) { return o.pair == pair; });
        if (known == out.end()) known = out.insert(out.end(), {pair, {}});
        if (known->owners.empty() || known->owners.back() != r) known->owners.push_back(r);
      }
    }
  }
  return out;
}

// One wall of a room is not two; a long wall along several rooms may be.
bool Exclusive(const OwnedPair& p, const OwnedPair& q) {
  if (p.pair.plan != q.pair.plan && p.pair.map != q.pair.map) return false;
  return std::any_of(p.owners.begin(), p.owners.end(),
                     [&](size_t o) { return std::find(q.owners.begin(), q.owners.end(), o) != q.owners.end(); });
}

Eigen::MatrixXd Affinities(const Comparison& comparison, const std::vector<OwnedPair>& pairs, const WallConsistency& bounds) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::MatrixXd affinity = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const OwnedPair &p = pairs[static_cast<size_t>(i)], &q = pairs[static_cast<size_t>(j)];
      if (!Exclusive(p, q)) affinity(i, j) = affinity(j, i) = comparison.Affinity(p.pair, q.pair, bounds);
    }
  }
  return affinity;
}

bool AllParallel(const MatchGraph& plan, const std::vector<ScoredPair>& walls) {
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const ScoredPair& w : walls) scatter += plan.walls[w.pair.plan].normal * plan.walls[w.pair.plan].normal.transpose();
  const auto n = static_cast<double>(walls.size());
  return walls.empty() || scatter.determinant() < kMinDeterminant * n * n;
}

bool Holds(const std::vector<ScoredPair>& walls, const GraphWallPair& pair) {
  return std::any_of(walls.begin(), walls.end(), [&](const ScoredPair& w) { return w.pair == pair; });
}

size_t WallsIn(const MatchGraph& plan, const MatchGraph& map, const std::vector<ScoredPair>& walls, const RoomPair& room) {
  const std::vector<size_t>&of_plan = plan.rooms[room.plan_room].walls, &of_map = map.rooms[room.map_room].walls;
  return static_cast<size_t>(std::count_if(walls.begin(), walls.end(), [&](const ScoredPair& w) {
    return std::find(of_plan.begin(), of_plan.end(), w.pair.plan) != of_plan.end() &&
           std::find(of_map.begin(), of_map.end(), w.pair.map) != of_map.end();
  }));
}

// Pairs of walls of matched rooms that are in no match of that pair of rooms.
std::vector<GraphWallPair> OpenPairs(const MatchGraph& plan, const MatchGraph& map, const Candidate2D& candidate) {
  std::vector<GraphWallPair> out;
  for (const RoomPair& room : candidate.rooms) {
    const std::vector<size_t>&of_plan = plan.rooms[room.plan_room].walls, &of_map = map.rooms[room.map_room].walls;
    const auto taken = [&](size_t w, bool in_plan) {
      return std::any_of(candidate.walls.begin(), candidate.walls.end(), [&](const ScoredPair& m) {
        if ((in_plan ? m.pair.plan : m.pair.map) != w) return false;
        const std::vector<size_t>& others = in_plan ? of_map : of_plan;  // matched to a wall of this room, not of its neighbour
        return std::find(others.begin(), others.end(), in_plan ? m.pair.map : m.pair.plan) != others.end();
      });
    };
    for (size_t a : of_plan) {
      if (taken(a, true)) continue;
      for (size_t s : of_map) {
        if (!taken(s, false)) out.push_back({a, s});
      }
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

// Best first, each wall of the map once and each of the plan.
std::vector<ScoredPair> OneToOne(std::vector<ScoredPair> pairs) {
  std::stable_sort(pairs.begin(), pairs.end(), [](const ScoredPair& p, const ScoredPair& q) { return p.score > q.score; });
  std::vector<ScoredPair> out;
  for (const ScoredPair& p : pairs) {
    const bool taken =
        std::any_of(out.begin(), out.end(), [&](const ScoredPair& o) { return o.pair.plan == p.pair.plan || o.pair.map == p.pair.map; });
    if (!taken) out.push_back(p);
  }
  return out;
}

std::vector<GraphWallPair> Pairs(const std::vector<ScoredPair>& walls) {
  std::vector<GraphWallPair> out;
  for (const ScoredPair& w : walls) out.push_back(w.pair);
  return out;
}

Eigen::Vector2d Middle(const MatchGraph& map, const std::vector<RoomPair>& rooms) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const RoomPair& r : rooms) sum += map.rooms[r.map_room].center;
  return sum / static_cast<double>(rooms.size());
}

// Takes in what else of the rooms' walls agrees with all that do, now that the place is known better, and scores all of them.
void Complete(const MatchGraph& plan, const MatchGraph& map, Candidate2D* candidate, const GraphMatcherOptions& options) {
  candidate->pose = Align(plan, map, Pairs(candidate->walls), candidate->pose);
  const Comparison comparison(plan, map, candidate->pose, candidate->origin);
  std::vector<ScoredPair> more;
  for (const GraphWallPair& pair : OpenPairs(plan, map, *candidate)) {
    if (comparison.AgreesWithAll(pair, candidate->walls, options.tight))
      more.push_back({pair, comparison.Mean(pair, candidate->walls, options.tight)});
  }
  for (const ScoredPair& pair : OneToOne(std::move(more))) candidate->walls.push_back(pair);
  std::sort(candidate->walls.begin(), candidate->walls.end(), [](const ScoredPair& p, const ScoredPair& q) { return p.pair < q.pair; });
  candidate->pose = Align(plan, map, Pairs(candidate->walls), candidate->pose);
  candidate->density = 0;
  for (ScoredPair& w : candidate->walls) {
    w.score = comparison.Mean(w.pair, candidate->walls, options.tight);
    candidate->density += w.score / static_cast<double>(candidate->walls.size());
  }
  candidate->density = 1 + candidate->density * static_cast<double>(candidate->walls.size() - 1);
}

// Middle of a wall; where nobody knows how far it reaches, some point on it.
Eigen::Vector2d PointOn(const GraphWall& w) {
  return w.has_extent() ? Eigen::Vector2d((w.start + w.end) / 2) : Eigen::Vector2d(-w.d_m * w.normal);
}

double Offset_m(const GraphWall& plan, const GraphWall& map, const PlanarPose& pose) {
  return std::abs(plan.normal.dot(pose.rotation() * PointOn(map) + pose.t_m) + plan.d_m);
}

// The part of two segments, the map's moved by `pose`, that lies side by side.
double Overlap_m(const GraphWall& plan, const GraphWall& map, const PlanarPose& pose) {
  const Eigen::Vector2d along = (plan.end - plan.start).normalized();
  const double length_m = (plan.end - plan.start).norm();
  const double a_m = along.dot(pose.rotation() * map.start + pose.t_m - plan.start),
               b_m = along.dot(pose.rotation() * map.end + pose.t_m - plan.start);
  return std::min(length_m, std::max(a_m, b_m)) - std::max(0.0, std::min(a_m, b_m));
}

}  // namespace

PlanarPose Align(const MatchGraph& plan, const MatchGraph& map, std::span<const GraphWallPair> walls, const PlanarPose& start) {
  PlanarPose pose = start;
  Eigen::Vector2d heading = Eigen::Vector2d::Zero();
  for (const GraphWallPair& w : walls) {
    const double yaw_rad = YawOf(plan.walls[w.plan], map.walls[w.map]);
    heading += Eigen::Vector2d(std::cos(yaw_rad), std::sin(yaw_rad));
  }
  if (heading.norm() > 0) pose.yaw_rad = std::atan2(heading.y(), heading.x());
  // Turned about the middle of the walls: where the start's shift is to be kept, it is theirs and not the map's origin's.
  std::vector<Eigen::Vector2d> middles;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  for (const GraphWallPair& w : walls) {
    middles.push_back(PointOn(map.walls[w.map]));
    center += middles.back() / static_cast<double>(walls.size());
  }
  const Eigen::Vector2d place = start.rotation() * center + start.t_m;
  Eigen::Matrix2d information = kStartWeight * Eigen::Matrix2d::Identity();
  Eigen::Vector2d right = kStartWeight * place;
  for (size_t i = 0; i < walls.size(); ++i) {
    const GraphWall& a = plan.walls[walls[i].plan];
    information += a.normal * a.normal.transpose();
    right -= a.normal * (a.d_m + a.normal.dot(pose.rotation() * (middles[i] - center)));
  }
  pose.t_m = information.inverse() * right - pose.rotation() * center;
  return pose;
}

std::optional<Candidate2D> MatchWalls(const MatchGraph& plan, const MatchGraph& map, const std::vector<RoomPair>& rooms,
                                      const GraphMatcherOptions& options) {
  const auto base =
      std::max_element(rooms.begin(), rooms.end(), [](const RoomPair& p, const RoomPair& q) { return p.density < q.density; });
  if (base == rooms.end()) return std::nullopt;
  const Eigen::Vector2d &in_plan = plan.rooms[base->plan_room].center, &in_map = map.rooms[base->map_room].center;
  const std::vector<OwnedPair> pairs = AllPairs(rooms);
  Clique best;
  PlanarPose pose;
  for (const std::vector<GraphWallPair>& group : base->groups) {
    PlanarPose start;
    start.yaw_rad = base->yaw_rad;
    start.t_m = in_plan - start.rotation() * in_map;
    start = Align(plan, map, group, start);
    Clique clique = DensestClique(Affinities(Comparison(plan, map, start, in_map), pairs, options.tight));
    if (clique.density <= best.density) continue;
    best = std::move(clique);
    pose = start;
  }
  Candidate2D candidate;
  candidate.pose = pose;
  for (size_t member : best.members) candidate.walls.push_back({pairs[member].pair, 0});
  for (const RoomPair& room : rooms) {
    if (WallsIn(plan, map, candidate.walls, room) >= kMinWalls) candidate.rooms.push_back(room);
  }
  if (candidate.rooms.size() < static_cast<size_t>(options.min_rooms) || AllParallel(plan, candidate.walls)) return std::nullopt;
  candidate.origin = Middle(map, candidate.rooms);
  Complete(plan, map, &candidate, options);
  const double mean = (candidate.density - 1) / static_cast<double>(candidate.walls.size() - 1);
  return mean >= options.min_global_affinity ? std::optional(candidate) : std::nullopt;
}

std::optional<Candidate2D> WithRoom(const MatchGraph& plan, const MatchGraph& map, const Candidate2D& candidate, const RoomPair& room,
                                    const GraphMatcherOptions& options) {
  if (std::abs(WrapAngle(room.yaw_rad - candidate.pose.yaw_rad)) >= options.relaxed.epsilon_rad) return std::nullopt;
  const Comparison comparison(plan, map, candidate.pose, map.rooms[room.map_room].center);
  Candidate2D out = candidate;
  std::vector<OwnedPair> pairs = AllPairs({room});
  std::erase_if(pairs, [&](const OwnedPair& p) {
    return !Holds(candidate.walls, p.pair) && comparison.Mean(p.pair, candidate.walls, options.tight) < options.min_global_affinity;
  });
  for (size_t member : DensestClique(Affinities(comparison, pairs, options.tight)).members) {
    if (!Holds(out.walls, pairs[member].pair)) out.walls.push_back({pairs[member].pair, 0});
  }
  if (WallsIn(plan, map, out.walls, room) < kMinWalls) return std::nullopt;
  out.rooms.push_back(room);
  Complete(plan, map, &out, options);
  return out;
}

std::vector<ScoredPair> DeviatedWalls(const MatchGraph& plan, const MatchGraph& map, const Candidate2D& candidate,
                                      const GraphMatcherOptions& options) {
  const Comparison comparison(plan, map, candidate.pose, candidate.origin);
  std::vector<ScoredPair> deviated;
  for (const GraphWallPair& pair : OpenPairs(plan, map, candidate)) {
    if (Offset_m(plan.walls[pair.plan], map.walls[pair.map], candidate.pose) > options.max_deviation_m) continue;
    const double score = comparison.DeviatedMean(pair, candidate.walls, options.relaxed);
    if (score >= options.min_deviated_affinity) deviated.push_back({pair, score});
  }
  return OneToOne(std::move(deviated));
}

std::vector<ScoredPair> OrphanWalls(const MatchGraph& plan, const MatchGraph& map, const Candidate2D& candidate,
                                    const GraphMatcherOptions& options) {
  const Comparison comparison(plan, map, candidate.pose, candidate.origin);
  std::vector<bool> taken(plan.walls.size(), false);
  for (const ScoredPair& w : candidate.walls) taken[w.pair.plan] = true;
  std::vector<ScoredPair> orphans;
  for (size_t s : map.Orphans()) {
    std::optional<ScoredPair> best;
    double best_overlap_m = 0;
    for (size_t a = 0; a < plan.walls.size(); ++a) {
      if (taken[a]) continue;
      const GraphWall &in_plan = plan.walls[a], &in_map = map.walls[s];
      const double overlap_m = in_plan.has_extent() && in_map.has_extent() ? Overlap_m(in_plan, in_map, candidate.pose) : kMinOverlap_m;
      if (overlap_m < kMinOverlap_m || (best && overlap_m <= best_overlap_m)) continue;
      if (!comparison.AgreesWithAll({a, s}, candidate.walls, options.tight)) continue;
      best = {{a, s}, comparison.Mean({a, s}, candidate.walls, options.tight)};
      best_overlap_m = overlap_m;
    }
    if (best) orphans.push_back(*best);
  }
  return orphans;
}

}  // namespace plumb::runtime
