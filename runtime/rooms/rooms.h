// The upper layers of the S-Graph: floors (storeys), rooms, corridors and doorways, derived from its keyframes and surfaces.
//
// They are no variables of any estimate: a room is what its walls make of it, and a factor on it would count their measurements twice
// (runtime/METHOD.md, "Rooms of the map"). They are computed when asked for.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/rooms/room_options.h"

namespace plumb::runtime {

// Everything in the map frame. Ids are positions in the vectors of UpperLayers.
using Polygon2 = std::vector<Eigen::Vector2d>;  // not closed: the last point is not the first again

struct MapFloor {
  uint32_t id = 0;
  double sensor_z_m = 0;                         // where the robot settled
  std::optional<double> floor_z_m, ceiling_z_m;  // where seen; a planar laser sees neither
  std::vector<uint32_t> keyframes;               // those on stairs belong to the nearer floor
};

struct MapRoom {
  uint32_t id = 0, floor = 0;
  Polygon2 polygon;                                  // counter-clockwise, on the surfaces that bound it
  std::vector<Polygon2> holes;                       // clockwise: pillars, cores
  double area_m2 = 0;                                // of the polygon less its holes
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  // area centroid of `polygon`
  std::vector<uint32_t> surfaces;                    // ids of the wall surfaces on its outline, ascending
  std::vector<uint32_t> doorways;
  double covered_ratio = 0;  // share of the outline, without doorways, that surfaces cover
  bool closed = false;       // surfaces cover half of the outline or more, and nowhere else is more than 0.6 m of it unseen
  bool visited = false;      // a keyframe stands in it; else it was only looked into
};

struct MapDoorway {
  uint32_t id = 0, floor = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // middle of the opening, in the middle of its wall
  double yaw_rad = 0;                                  // direction of the passage, from room_a
  double width_m = 0;
  uint32_t room_a = 0;
  std::optional<uint32_t> room_b;  // none: to where too little was seen to be a room, or outside
};

// Two parallel walls that face each other, with free space between, in a room that is not closed.
struct MapCorridor {
  uint32_t id = 0, room = 0;
  uint32_t surface_a = 0, surface_b = 0;                                           // ids of the surfaces
  Eigen::Vector2d start = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();  // of the centre line, as far as both walls run
  double width_m = 0;
};

struct UpperLayers {
  std::vector<MapFloor> floors;  // ascending
  std::vector<MapRoom> rooms;    // by floor
  std::vector<MapDoorway> doorways;
  std::vector<MapCorridor> corridors;
};

// `options` must pass Check(). Deterministic. O(keyframe points + rays + free cells), see runtime/README.md for times.
[[nodiscard]] UpperLayers DeriveUpperLayers(const SGraph& graph, const RoomOptions& options = {});

}  // namespace plumb::runtime
