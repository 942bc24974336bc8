#include "runtime/matching/graph/room_pairs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "runtime/matching/graph/densest_clique.h"

namespace plumb::runtime {
namespace {

constexpr size_t kMinGroup = 2;

// Neighbourhoods have fewer local optima than whole graphs, and there are many of them.
DensestCliqueOptions FewStarts() {
  DensestCliqueOptions options;
  options.starts = 3;
  return options;
}

double MeanYaw(const MatchGraph& plan, const MatchGraph& map, const std::vector<GraphWallPair>& walls) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const GraphWallPair& w : walls) {
    const double yaw_rad = YawOf(plan.walls[w.plan], map.walls[w.map]);
    sum += Eigen::Vector2d(std::cos(yaw_rad), std::sin(yaw_rad));
  }
  return std::atan2(sum.y(), sum.x());
}

// Walls of two rooms that are about as far from the rooms' centres.
std::vector<GraphWallPair> PossibleWalls(const MatchGraph& plan, const GraphRoom& a, const MatchGraph& map, const GraphRoom& s,
                                    double epsilon_m) {
  std::vector<GraphWallPair> out;
  for (size_t i : a.walls) {
    const double plan_m = plan.walls[i].normal.dot(a.center) + plan.walls[i].d_m;
    for (size_t j : s.walls) {
      const double map_m = map.walls[j].normal.dot(s.center) + map.walls[j].d_m;
      if (std::abs(plan_m - map_m) < epsilon_m) out.push_back({i, j});
    }
  }
  return out;
}

struct WallGroup {
  std::vector<GraphWallPair> walls;
  double yaw_rad = 0, density = 0;
};

// Sets of walls that agree: of the largest size, and one fewer (with a wall that deviates, the true one may be smaller).
std::vector<WallGroup> WallGroups(const MatchGraph& plan, const GraphRoom& a, const MatchGraph& map, const GraphRoom& s,
                                  const GraphMatcherOptions& options) {
  const std::vector<GraphWallPair> pairs = PossibleWalls(plan, a, map, s, options.room_wall_epsilon_m);
  if (pairs.size() < kMinGroup) return {};
  std::vector<WallPoint> in_plan, in_map;
  for (const GraphWallPair& p : pairs) {
    in_plan.push_back(AboutOrigin(plan.walls[p.plan].normal, plan.walls[p.plan].d_m, a.center));
    in_map.push_back(AboutOrigin(map.walls[p.map].normal, map.walls[p.map].d_m, s.center));
  }
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::MatrixXd affinity = Eigen::MatrixXd::Identity(n, n);
  for (size_t i = 0; i < pairs.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      if (pairs[i].plan == pairs[j].plan || pairs[i].map == pairs[j].map) continue;
      const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
      affinity(row, column) = affinity(column, row) = WallAffinityUpToShift(in_plan[i], in_plan[j], in_map[i], in_map[j], options.tight);
    }
  }
  std::vector<WallGroup> groups;
  size_t largest = kMinGroup;
  for (const Clique& clique : CoveringCliques(affinity, FewStarts())) {
    const auto size = static_cast<double>(clique.members.size());
    if (clique.members.size() < kMinGroup || clique.density / size < options.min_wall_score) continue;
    WallGroup group;
    for (size_t member : clique.members) group.walls.push_back(pairs[member]);
    group.yaw_rad = MeanYaw(plan, map, group.walls);
    group.density = clique.density;
    largest = std::max(largest, group.walls.size());
    groups.push_back(std::move(group));
  }
  std::erase_if(groups, [&](const WallGroup& g) { return g.walls.size() + 1 < largest; });
  return groups;
}

double Agreement(const MatchGraph& plan, const MatchGraph& map, const RoomPair& p, const RoomPair& q, const GraphMatcherOptions& options) {
  if (p.plan_room == q.plan_room || p.map_room == q.map_room) return 0;
  if (std::abs(WrapAngle(p.yaw_rad - q.yaw_rad)) >= options.relaxed.epsilon_rad) return 0;
  const Eigen::Vector2d &a_p = plan.rooms[p.plan_room].center, &a_q = plan.rooms[q.plan_room].center;
  const Eigen::Vector2d &s_p = map.rooms[p.map_room].center, &s_q = map.rooms[q.map_room].center;
  // The way from one to the other, too, must be turned by the yaw of their walls: distances alone are the same in a mirror image.
  const Eigen::Vector2d in_plan = a_q - a_p, in_map = Eigen::Rotation2Dd(p.yaw_rad) * (s_q - s_p);
  const double slack_m = options.room.epsilon_m + options.relaxed.epsilon_rad * in_map.norm();
  if ((in_plan - in_map).norm() >= slack_m) return 0;
  return PointAffinity(a_p, a_q, s_p, s_q, options.room);
}

}  // namespace

double YawOf(const GraphWall& plan, const GraphWall& map) {
  return std::atan2(Cross(map.normal, plan.normal), map.normal.dot(plan.normal));
}

std::vector<RoomPair> PairRooms(const MatchGraph& plan, const MatchGraph& map, const GraphMatcherOptions& options) {
  std::vector<RoomPair> pairs;
  for (size_t a = 0; a < plan.rooms.size(); ++a) {
    for (size_t s = 0; s < map.rooms.size(); ++s) {
      const size_t first = pairs.size();
      for (WallGroup& group : WallGroups(plan, plan.rooms[a], map, map.rooms[s], options)) {
        const auto same_yaw = std::find_if(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end(), [&](const RoomPair& p) {
          return std::abs(WrapAngle(p.yaw_rad - group.yaw_rad)) < options.relaxed.epsilon_rad;
        });
        if (same_yaw == pairs.end()) {
          pairs.push_back({a, s, group.yaw_rad, {std::move(group.walls)}, group.density});
        } else {
          same_yaw->density = std::max(same_yaw->density, group.density);
          same_yaw->groups.push_back(std::move(group.walls));
        }
      }
    }
  }
  const auto most = static_cast<size_t>(options.max_room_pairs);
  if (pairs.size() <= most) return pairs;
  std::stable_sort(pairs.begin(), pairs.end(), [](const RoomPair& p, const RoomPair& q) { return p.density > q.density; });
  pairs.resize(most);
  return pairs;
}

std::vector<std::vector<size_t>> RoomSets(const MatchGraph& plan, const MatchGraph& map, const std::vector<RoomPair>& pairs,
                                          const GraphMatcherOptions& options) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  Eigen::MatrixXd affinity = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      affinity(i, j) = affinity(j, i) = Agreement(plan, map, pairs[static_cast<size_t>(i)], pairs[static_cast<size_t>(j)], options);
    }
  }
  std::vector<std::vector<size_t>> sets;
  for (Clique& clique : CoveringCliques(affinity, FewStarts())) {
    const size_t size = clique.members.size();
    if (size < static_cast<size_t>(options.min_rooms) || clique.density / static_cast<double>(size) < options.min_room_score) continue;
    sets.push_back(std::move(clique.members));
  }
  return sets;
}

}  // namespace plumb::runtime
