// The diS-Graphs authors' matcher: rooms first, then their walls, by pairwise geometric consistency alone; no rays, no deviations modelled.
// For comparison with the matcher by walls (matcher.h). What is done otherwise than in their paper and code, and why: runtime/METHOD.md,
// "Matching by graphs".
#pragma once

#include <string>
#include <vector>

#include "runtime/matching/graph/affinity.h"
#include "runtime/matching/graph/match_graph.h"
#include "runtime/matching/matcher.h"
#include "runtime/matching/planar_pose.h"

namespace plumb::runtime {

// Names and values of the authors' parameters for their tests with deviations of 9 cm and more; their other sets match walls 20 cm off as
// if they were none. A score is a density per vertex (DensestClique), so 0.5 for two that agree and 1 for ever more.
struct GraphMatcherOptions {
  PointConsistency room{0.5, 0.2};                // of room centres
  WallConsistency tight{0.5, 0.1, 0.05, 0.1};     // of walls as planned
  WallConsistency relaxed{0.5, 0.15, 0.05, 0.2};  // of walls that deviate
  double room_wall_epsilon_m = 0.3;    // a wall's distance from its room's centre; a wall that is moved moves the centre by half of that
  double min_room_score = 0.2;         // of a set of rooms
  double min_wall_score = 0.1;         // of the walls of a room
  double min_global_affinity = 0.2;    // mean over all walls of a candidate
  double min_deviated_affinity = 0.3;  // mean of a deviated wall with all matched ones
  double max_deviation_m = 0.5;        // what stands off further is another wall
  double symmetry_epsilon = 0.01;      // candidates are equally good that differ by less, per wall of the map's rooms, in how much agrees
  double min_matched_ratio = 0.5;      // of the walls of the map's rooms; fewer that agree are no match
  int min_rooms = 2;
  int max_room_pairs = 1500;  // the best are looked at: bounds the time
  int max_candidates = 64;    // whose walls without a room are looked at
  GraphRooms rooms = GraphRooms::kFourWalls;
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

struct RoomMatch {
  uint32_t plan_room = 0, map_room = 0;  // ids
  double score = 0;                      // of its walls by themselves
};

struct WallMatch {
  uint32_t plan_wall = 0, map_wall = 0;  // ids
  double score = 0;  // mean affinity with all other matched walls that do not deviate; 1 - score: how likely it deviates
  bool deviated = false;
  bool orphan = false;  // in no room of the map
};

struct GraphMatch {
  MatchResult::Verdict verdict = MatchResult::Verdict::kSearching;
  std::vector<RoomMatch> rooms;    // by map room
  std::vector<WallMatch> walls;    // by map wall
  PlanarPose pose;                 // T_plan_map by the walls that do not deviate; z_m is 0
  double score = 0;                // share of the walls of the map's rooms that agree
  double support = 0;              // how many walls agree, each as well as it agrees with the others
  std::vector<PlanarPose> rivals;  // other places that are as good; when ambiguous
  size_t candidates = 0;           // consistent sets of rooms and walls
  std::string reason;              // why it is not unique; empty when it is
};

// Deterministic.
class GraphMatcher {
 public:
  explicit GraphMatcher(MatchGraph plan, const GraphMatcherOptions& options = {});

  // From nothing: the authors' global matching. Ambiguous when places that differ are equally good; no match if the plan's mirror image, a
  // building that is not the plan's, agrees better.
  // O(plan rooms * map rooms) pairs of rooms, of which at most max_room_pairs go on; quadratic in these.
  [[nodiscard]] GraphMatch Match(const MatchGraph& map) const;

  // Their local matching: `known`, which must be unique, stays; rooms that are new are matched so that their walls agree with the known
  // ones, then deviated walls and walls without a room. Rooms of which more than half of the walls are known are not new. Walls are known
  // by their ids.
  [[nodiscard]] GraphMatch Extend(const MatchGraph& map, const GraphMatch& known) const;

 private:
  MatchGraph plan_, mirror_image_;
  GraphMatcherOptions options_;
};

}  // namespace plumb::runtime
