#include "runtime/matching/graph/graph_matcher.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runtime/matching/graph/room_pairs.h"
#include "runtime/matching/graph/wall_matching.h"

namespace plumb::runtime {
namespace {

constexpr double kSamePlace_m = 0.5, kSamePlace_rad = 0.17;
constexpr double kSameWall_m = 0.1, kSameWall_rad = 0.05, kOwnMirrorImageRatio = 0.95;  // of the rooms' walls

MatchGraph MirrorImage(MatchGraph graph) {
  for (GraphRoom& room : graph.rooms) room.center.x() = -room.center.x();
  for (GraphWall& wall : graph.walls) {
    wall.normal.x() = -wall.normal.x();
    wall.start.x() = -wall.start.x();
    wall.end.x() = -wall.end.x();
  }
  return graph;
}

// A map at `pose` in the plan and at `mirrored_pose` in its mirror image says how the one would lie on the other. True if it does: then a
// better place in the mirror image is one in the plan.
bool IsOwnMirrorImage(const MatchGraph& plan, const MatchGraph& image, const PlanarPose& pose, const PlanarPose& mirrored_pose) {
  const Eigen::Matrix2d R = pose.rotation() * mirrored_pose.rotation().transpose();
  const Eigen::Vector2d t = pose.t_m - R * mirrored_pose.t_m;
  size_t walls = 0, same = 0;
  for (const GraphRoom& room : image.rooms) {
    for (size_t w : room.walls) {
      const GraphWall& wall = image.walls[w];
      const Eigen::Vector2d normal = R * wall.normal,
                            foot = R * (room.center - (wall.normal.dot(room.center) + wall.d_m) * wall.normal) + t;
      ++walls;
      same += std::any_of(plan.rooms.begin(), plan.rooms.end(), [&](const GraphRoom& r) {
        if ((r.center - (R * room.center + t)).norm() > kSamePlace_m) return false;
        return std::any_of(r.walls.begin(), r.walls.end(), [&](size_t p) {
          const GraphWall& other = plan.walls[p];
          return normal.dot(other.normal) > std::cos(kSameWall_rad) && std::abs(other.normal.dot(foot) + other.d_m) < kSameWall_m;
        });
      });
    }
  }
  return static_cast<double>(same) > kOwnMirrorImageRatio * static_cast<double>(walls);
}

// Walls that a graph's rooms have, each counted once.
double CountWalls(const MatchGraph& map) {
  std::set<size_t> walls;
  for (const GraphRoom& room : map.rooms) walls.insert(room.walls.begin(), room.walls.end());
  return static_cast<double>(walls.size());
}

double MatchedRatio(const MatchGraph& map, const Candidate2D& candidate) {
  std::set<size_t> matched;
  for (const ScoredPair& w : candidate.walls) matched.insert(w.pair.map);
  return static_cast<double>(matched.size()) / CountWalls(map);
}

Eigen::Vector2d MiddleOfRooms(const MatchGraph& map) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const GraphRoom& room : map.rooms) sum += room.center;
  return sum / static_cast<double>(map.rooms.size());
}

bool SamePlace(const PlanarPose& a, const PlanarPose& b, const Eigen::Vector2d& middle) {
  return std::abs(WrapAngle(a.yaw_rad - b.yaw_rad)) < kSamePlace_rad &&
         (a.rotation() * middle + a.t_m - b.rotation() * middle - b.t_m).norm() < kSamePlace_m;
}

void AddOrphans(const MatchGraph& plan, const MatchGraph& map, Candidate2D* candidate, const GraphMatcherOptions& options) {
  candidate->orphans = OrphanWalls(plan, map, *candidate, options);
  candidate->support = candidate->density;
  for (const ScoredPair& orphan : candidate->orphans) candidate->support += orphan.score;
}

// Consistent candidates, best supported first, of those at the same place only the densest.
std::vector<Candidate2D> Candidates(const MatchGraph& plan, const MatchGraph& map, const GraphMatcherOptions& options) {
  const std::vector<RoomPair> pairs = PairRooms(plan, map, options);
  std::vector<Candidate2D> all;
  for (const std::vector<size_t>& set : RoomSets(plan, map, pairs, options)) {
    std::vector<RoomPair> rooms;
    for (size_t i : set) rooms.push_back(pairs[i]);
    if (std::optional<Candidate2D> candidate = MatchWalls(plan, map, rooms, options)) all.push_back(std::move(*candidate));
  }
  std::stable_sort(all.begin(), all.end(), [](const Candidate2D& a, const Candidate2D& b) { return a.density > b.density; });
  const Eigen::Vector2d middle = MiddleOfRooms(map);
  std::vector<Candidate2D> distinct;
  for (Candidate2D& c : all) {
    if (distinct.size() == static_cast<size_t>(options.max_candidates)) break;
    const bool known =
        std::any_of(distinct.begin(), distinct.end(), [&](const Candidate2D& d) { return SamePlace(c.pose, d.pose, middle); });
    if (!known) distinct.push_back(std::move(c));
  }
  for (Candidate2D& c : distinct) AddOrphans(plan, map, &c, options);
  std::stable_sort(distinct.begin(), distinct.end(), [](const Candidate2D& a, const Candidate2D& b) { return a.support > b.support; });
  return distinct;
}

// The candidate with its ids, and what deviates.
void Describe(const MatchGraph& plan, const MatchGraph& map, const Candidate2D& candidate, const GraphMatcherOptions& options,
              GraphMatch* out) {
  out->pose = candidate.pose;
  out->support = candidate.support;
  for (const RoomPair& r : candidate.rooms) {
    const double full = static_cast<double>(map.rooms[r.map_room].walls.size());
    out->rooms.push_back({plan.rooms[r.plan_room].id, map.rooms[r.map_room].id, r.density / full});
  }
  const auto add = [&](const std::vector<ScoredPair>& pairs, bool deviated, bool orphan) {
    for (const ScoredPair& p : pairs)
      out->walls.push_back({plan.walls[p.pair.plan].id, map.walls[p.pair.map].id, p.score, deviated, orphan});
  };
  add(candidate.walls, false, false);
  add(DeviatedWalls(plan, map, candidate, options), true, false);
  add(candidate.orphans, false, true);
  std::stable_sort(out->rooms.begin(), out->rooms.end(), [](const RoomMatch& a, const RoomMatch& b) { return a.map_room < b.map_room; });
  std::stable_sort(out->walls.begin(), out->walls.end(), [](const WallMatch& a, const WallMatch& b) { return a.map_wall < b.map_wall; });
}

size_t WallWithId(const MatchGraph& graph, uint32_t id) {
  const auto at = std::find_if(graph.walls.begin(), graph.walls.end(), [&](const GraphWall& w) { return w.id == id; });
  return static_cast<size_t>(at - graph.walls.begin());
}

// The known match in terms of `map`, as far as it still has the walls.
Candidate2D Recalled(const MatchGraph& plan, const MatchGraph& map, const GraphMatch& known) {
  Candidate2D out;
  out.pose = known.pose;
  out.origin = MiddleOfRooms(map);
  for (const WallMatch& w : known.walls) {
    const GraphWallPair pair{WallWithId(plan, w.plan_wall), WallWithId(map, w.map_wall)};
    if (w.deviated || w.orphan || pair.plan == plan.walls.size() || pair.map == map.walls.size()) continue;
    out.walls.push_back({pair, w.score});
  }
  return out;
}

}  // namespace

std::string GraphMatcherOptions::Check() const {
  for (std::string wrong : {room.Check(), tight.Check(), relaxed.Check()})
    if (!wrong.empty()) return wrong;
  const auto bad = [](const char* name, double value, const char* rule) {
    return fmt::format("GraphMatcherOptions.{} = {}; must be {}", name, value, rule);
  };
  if (!(max_deviation_m > 0)) return bad("max_deviation_m", max_deviation_m, "positive");
  if (!(room_wall_epsilon_m > 0)) return bad("room_wall_epsilon_m", room_wall_epsilon_m, "positive");
  const std::pair<const char*, double> ratios[] = {
      {"min_room_score", min_room_score},           {"min_wall_score", min_wall_score},
      {"min_global_affinity", min_global_affinity}, {"min_deviated_affinity", min_deviated_affinity},
      {"symmetry_epsilon", symmetry_epsilon},       {"min_matched_ratio", min_matched_ratio}};
  for (const auto& [name, value] : ratios)
    if (!(value >= 0 && value <= 1)) return bad(name, value, "in [0, 1]");
  if (min_rooms < 1) return bad("min_rooms", min_rooms, "at least 1");
  if (max_room_pairs < 1) return bad("max_room_pairs", max_room_pairs, "at least 1");
  if (max_candidates < 2) return bad("max_candidates", max_candidates, "at least 2");
  return {};
}

GraphMatcher::GraphMatcher(MatchGraph plan, const GraphMatcherOptions& options)
    : plan_(std::move(plan)), mirror_image_(MirrorImage(plan_)), options_(options) {}

GraphMatch GraphMatcher::Match(const MatchGraph& map) const {
  GraphMatch out;
  if (map.rooms.size() < static_cast<size_t>(options_.min_rooms)) {
    out.reason = fmt::format("the map has {} of the {} rooms that matching by graphs needs", map.rooms.size(), options_.min_rooms);
    return out;
  }
  const std::vector<Candidate2D> candidates = Candidates(plan_, map, options_);
  out.candidates = candidates.size();
  if (candidates.empty()) {
    out.reason = fmt::format("no {} rooms of the map agree with rooms of the plan", options_.min_rooms);
    return out;
  }
  const double walls = CountWalls(map);
  const Candidate2D& best = candidates.front();
  out.score = MatchedRatio(map, best);
  if (out.score < options_.min_matched_ratio) {
    out.reason = fmt::format("{:.0f} % of the walls of the map's rooms agree with the plan, fewer than {:.0f} %", 100 * out.score,
                             100 * options_.min_matched_ratio);
    return out;
  }
  const std::vector<Candidate2D> mirrored = Candidates(mirror_image_, map, options_);
  if (!mirrored.empty() && mirrored.front().support > best.support + options_.symmetry_epsilon * walls &&
      !IsOwnMirrorImage(plan_, mirror_image_, best.pose, mirrored.front().pose)) {
    out.reason = "the rooms of the map agree better with the plan's mirror image";
    return out;
  }
  for (size_t i = 1; i < candidates.size(); ++i) {
    if ((best.support - candidates[i].support) / walls <= options_.symmetry_epsilon) out.rivals.push_back(candidates[i].pose);
  }
  out.verdict = out.rivals.empty() ? MatchResult::Verdict::kUnique : MatchResult::Verdict::kAmbiguous;
  if (!out.rivals.empty()) out.reason = fmt::format("{} places agree equally well with the rooms of the map", out.rivals.size() + 1);
  Describe(plan_, map, best, options_, &out);
  return out;
}

GraphMatch GraphMatcher::Extend(const MatchGraph& map, const GraphMatch& known) const {
  Candidate2D candidate = Recalled(plan_, map, known);
  const auto matched = [&](size_t wall) {
    return std::any_of(candidate.walls.begin(), candidate.walls.end(), [&](const ScoredPair& w) { return w.pair.map == wall; });
  };
  // Rooms that are matched leave: without walls they pair with nothing.
  MatchGraph plan = plan_, rest = map;
  for (GraphRoom& r : plan.rooms) {
    if (std::any_of(known.rooms.begin(), known.rooms.end(), [&](const RoomMatch& m) { return m.plan_room == r.id; })) r.walls.clear();
  }
  for (GraphRoom& r : rest.rooms) {
    if (2 * std::count_if(r.walls.begin(), r.walls.end(), matched) > static_cast<std::ptrdiff_t>(r.walls.size())) r.walls.clear();
  }
  std::vector<RoomPair> pairs = PairRooms(plan, rest, options_);
  std::stable_sort(pairs.begin(), pairs.end(), [](const RoomPair& p, const RoomPair& q) { return p.density > q.density; });
  std::set<size_t> plan_rooms, map_rooms;
  for (const RoomPair& pair : pairs) {
    if (plan_rooms.contains(pair.plan_room) || map_rooms.contains(pair.map_room)) continue;
    std::optional<Candidate2D> extended = WithRoom(plan_, map, candidate, pair, options_);
    if (!extended) continue;
    candidate = std::move(*extended);
    plan_rooms.insert(pair.plan_room);
    map_rooms.insert(pair.map_room);
  }
  AddOrphans(plan_, map, &candidate, options_);
  GraphMatch out;
  out.verdict = known.verdict;
  out.rooms = known.rooms;
  for (const WallMatch& w : known.walls)
    if (w.deviated) out.walls.push_back(w);
  Describe(plan_, map, candidate, options_, &out);
  out.score = MatchedRatio(map, candidate);
  return out;
}

}  // namespace plumb::runtime
