// A small house as an A-Graph made by hand, for tests that need a plan but no compiler.
//
//   y=6 +-----------------+-----------+
//       |   B (5.0x2.4)   |           |     outer walls 0.30 m, inner walls 0.12 m; inner size 9.0 m x 6.0 m, 2.6 m high
//       +------D1---------+           |     rooms: A south-west, B north-west, C east
//       |                 D2    C     |     D1: A-B, D2: A-C, D3: A-outside (west wall, closed leaf)
//   D3  |   A             |           |     no rotational symmetry
//   y=0 +-----------------+-----------+
//       x=0              5.0        9.0
#pragma once

#include "schema/agraph.h"

namespace plumb::test {

[[nodiscard]] AGraph MakeHouse();

// What houses are made of, for tests that need another one. Storey 0, floor at z = 0.
inline constexpr double kHouseHeight_m = 2.6;
struct Gap {
  double from, to;  // door-high, along the wall's long axis
};
// A wall as an axis-aligned box from lo to hi.
WallId AddWall(AGraph& graph, const std::string& guid, Eigen::Vector2d lo, Eigen::Vector2d hi, const std::vector<Gap>& gaps = {});
// One side of a wall, free space to the left.
SurfaceId AddSurface(AGraph& graph, WallId wall, RoomId room, Eigen::Vector2d start, Eigen::Vector2d end);
// A rectangular room with its surfaces; walls in the order south, east, north, west.
void AddRoom(AGraph& graph, const std::string& name, Eigen::Vector2d lo, Eigen::Vector2d hi, const std::vector<WallId>& walls);
// 0.9 m wide.
void AddDoorway(AGraph& graph, const std::string& name, WallId wall, RoomId a, RoomId b, Eigen::Vector2d at, double yaw_rad, bool leaf);
uint32_t AddElement(AGraph& graph, const std::string& guid, ElementKind kind, WallId wall = {}, DoorwayId doorway = {});

// Adds an axis-aligned box [lo, hi] (plan frame) to the graph's mesh as `element`.
void AddBox(AGraph& graph, const Eigen::Vector3d& lo, const Eigen::Vector3d& hi, uint32_t element);

}  // namespace plumb::test
