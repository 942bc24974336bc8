// Plan or map as graph matching needs them: rooms, the walls around them, and walls without a room. In the ground plane: the maps are
// level, so that only yaw and a shift are unknown.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/rooms/rooms.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// The line normal . x + d = 0, normal a unit vector into the free space.
struct GraphWall {
  uint32_t id = 0;  // SurfaceId of a plan, MapSurface::id of a map; of several in one line the longest
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double d_m = 0;
  Eigen::Vector2d start = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();  // the same point where nobody knows

  [[nodiscard]] bool has_extent() const { return start != end; }
};

struct GraphRoom {
  uint32_t id = 0;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  std::vector<size_t> walls;  // MatchGraph::walls; a wall may bound several rooms
};

struct MatchGraph {
  std::vector<GraphRoom> rooms;
  std::vector<GraphWall> walls;

  [[nodiscard]] std::vector<size_t> Orphans() const;  // walls of no room, ascending
};

// Rooms of which four walls are known and that these four bound: their area is the room's to within this share. The centre is where
// opposite walls are as far. Else any room with three walls or more, and the centre of its area.
enum class GraphRooms { kFourWalls, kAny };
inline constexpr double kFourWallAreaRatio = 0.25;

// Rooms and walls of one storey of the plan. Plan frame less AGraph::origin, as the mesh. O(surfaces).
[[nodiscard]] MatchGraph PlanGraph(const AGraph& plan, StoreyId storey, GraphRooms rooms);

// Rooms and walls of one floor of the map. Map frame. O(surfaces).
[[nodiscard]] MatchGraph MapGraph(const SGraph& map, const UpperLayers& layers, uint32_t floor, GraphRooms rooms);

// Where the lines of a room's four walls are as far from opposite ones; none if they do not face each other in two pairs.
[[nodiscard]] std::optional<Eigen::Vector2d> FourWallCenter(const std::vector<GraphWall>& walls);

}  // namespace plumb::runtime
