// The walls of a set of rooms that agree across all of them, and what they say of the map's place in the plan.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/matching/graph/graph_matcher.h"
#include "runtime/matching/graph/room_pairs.h"

namespace plumb::runtime {

// A pair of walls with its mean affinity to all others of a match.
struct ScoredPair {
  GraphWallPair pair;
  double score = 0;
};

// Rooms and walls that agree with one place of the map.
struct Candidate2D {
  std::vector<RoomPair> rooms;
  std::vector<ScoredPair> walls, orphans;
  PlanarPose pose;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  // map frame: the middle of its rooms, about which walls are compared
  double density = 0;                                // of `walls`
  double support = 0;                                // density, and the orphans' scores
};

// Least squares over the walls: yaw, then the shift that puts the middle of each wall of the map on its line of the plan. What the walls
// leave open (a shift along parallel ones) stays as in `start`.
[[nodiscard]] PlanarPose Align(const MatchGraph& plan, const MatchGraph& map, std::span<const GraphWallPair> walls, const PlanarPose& start);

// The densest set of wall pairs across the rooms, about the centre of the best of them as its own walls place it. Rooms with fewer than two
// walls in it are left out; none if fewer than options.min_rooms remain, or all walls are parallel.
[[nodiscard]] std::optional<Candidate2D> MatchWalls(const MatchGraph& plan, const MatchGraph& map, const std::vector<RoomPair>& rooms,
                                                    const GraphMatcherOptions& options);

// The candidate with one more room, whose walls agree with the candidate's about the room's centre; none if fewer than two of them do.
[[nodiscard]] std::optional<Candidate2D> WithRoom(const MatchGraph& plan, const MatchGraph& map, const Candidate2D& candidate,
                                                  const RoomPair& room, const GraphMatcherOptions& options);

// Walls of the candidate's rooms that are not matched and agree with enough of those that are by the relaxed bounds, best first, each wall
// once.
[[nodiscard]] std::vector<ScoredPair> DeviatedWalls(const MatchGraph& plan, const MatchGraph& map, const Candidate2D& candidate,
                                                    const GraphMatcherOptions& options);

// Walls of no room of the map that agree with all matched walls by the tight bounds, each with the wall of the plan that it overlaps most.
[[nodiscard]] std::vector<ScoredPair> OrphanWalls(const MatchGraph& plan, const MatchGraph& map, const Candidate2D& candidate,
                                                  const GraphMatcherOptions& options);

}  // namespace plumb::runtime
