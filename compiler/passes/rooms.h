// Pass FloorIr -> A-Graph: rooms are the bounded faces that no wall covers.
#pragma once

#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/ir/floor_ir.h"

namespace plumb::compiler {

struct RoomOptions {
  double min_area_m2 = 0.5;         // smaller faces are shafts or gaps ...
  double min_closet_area_m2 = 0.25;  // ... but closets, if a door leads there
  double max_shaft_area_m2 = 1.5;   // faces up to this without a door, a window or a space of the source are shafts, too
  double min_width_m = 0.2;         // 2 * area / perimeter; narrower faces are cavities between double walls
  double min_clear_height_m = 1.5;  // lower ones are crawl spaces and foundations
  double min_floor_share = 0.1;     // of its area with a floor or stairs of its level; with less, and without a door, it is a void
  double collinear_m = 0.0015;      // a corner within this of the line through its neighbours is none
  [[nodiscard]] std::string Check() const;
};

// Per floor and face the room that it became; none for walls, gaps and the outside.
using RoomsByFace = std::vector<std::vector<RoomId>>;

// Appends to graph.rooms in the order of floors and faces; surfaces and names come later. Walls and columns that stand free become holes.
// Rooms that an opening wider than any door joins stay apart, with a doorway between them. Floor and ceiling heights are the medians of
// vertical probes into slabs, roofs, coverings and ground; stairs overhead are a ceiling where a person can stand below them. Where most of
// a room shows no floor, as in a stair hall, the floor before its doors counts. Without any: the storey's elevation and the next level's.
// Where slabs are drawn, the upper part of a room further down (a void) is no room of its own. Needs graph.storeys.
[[nodiscard]] RoomsByFace FindRooms(const PlanIr& plan, const FloorIr& floors, const RoomOptions& options, AGraph& graph,
                                    DiagnosticSink& sink);

}  // namespace plumb::compiler
