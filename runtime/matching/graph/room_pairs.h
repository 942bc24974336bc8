// Which room of the plan may be which room of the map, and which sets of such pairs agree with each other.
#pragma once

#include <compare>
#include <vector>

#include "runtime/matching/graph/graph_matcher.h"

namespace plumb::runtime {

// Positions in MatchGraph::walls.
struct GraphWallPair {
  size_t plan = 0, map = 0;
  friend auto operator<=>(const GraphWallPair&, const GraphWallPair&) = default;
};

// A room of the plan, a room of the map, and how the map would have to be turned for their walls to agree.
struct RoomPair {
  size_t plan_room = 0, map_room = 0;  // positions in MatchGraph::rooms
  double yaw_rad = 0;
  // Largest sets of walls that agree at this yaw. Several if a wall deviates: of two walls that face each other either may be the one.
  std::vector<std::vector<GraphWallPair>> groups;
  double density = 0;  // of the densest group
};

// All of which two walls or more agree, each about as far from the rooms' centres. By plan room, map room, then yaw; of more than
// options.max_room_pairs the densest.
[[nodiscard]] std::vector<RoomPair> PairRooms(const MatchGraph& plan, const MatchGraph& map, const GraphMatcherOptions& options);

// Sets of pairs (positions in `pairs`, ascending) whose rooms all differ, whose centres are as far in plan and map, and that turn the map
// alike.
[[nodiscard]] std::vector<std::vector<size_t>> RoomSets(const MatchGraph& plan, const MatchGraph& map, const std::vector<RoomPair>& pairs,
                                                        const GraphMatcherOptions& options);

// Yaw that turns the map's wall onto the plan's.
[[nodiscard]] double YawOf(const GraphWall& plan, const GraphWall& map);

}  // namespace plumb::runtime
