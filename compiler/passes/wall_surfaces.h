// Pass: the sides of walls as far as each bounds one room or the outside, and the factors that tie surfaces, walls and rooms.
#pragma once

#include "compiler/ir/floor_ir.h"
#include "compiler/passes/rooms.h"

namespace plumb::compiler {

struct SurfaceOptions {
  double collinear_m = 0.0015;  // edges of one wall this close to one line are one surface
  double arc_m = 0.003;         // corners this close to an arc of its wall lie on it
  double facet_m = 0.02;        // ... and their middles that close to it
  double min_length_m = 0.02;   // shorter ones are leftovers of joints
  double crack_m = 0.01;        // sides with less free space than this before them are none
  double min_external_m = 0.3;  // a wall with at least this much of a side to the outside is external
  [[nodiscard]] std::string Check() const;
};

// Walks the boundaries of rooms, then of the unbounded face, and makes one surface of each run along one wall and one line (or arc).
// Where several walls' outlines run together, the one along whose axis the edge goes owns it, then the thicker one. Columns own no surface;
// gaps that are no rooms have none. Sets Room::surfaces and Wall::external. Needs graph.walls (AddWalls) and graph.rooms (FindRooms).
void AddSurfaces(const FloorIr& floors, const RoomsByFace& rooms, const SurfaceOptions& options, AGraph& graph);

// Appends kWallSurfaces for each two opposite surfaces of a wall, kRoomSurfaces, kDoorwayRooms (two rooms) and kStoreyRoom.
void AddFactors(AGraph& graph);

}  // namespace plumb::compiler
