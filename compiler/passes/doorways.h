// Passes: doorways with the two rooms that each joins, and windows.
#pragma once

#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/passes/host_openings.h"
#include "compiler/passes/rooms.h"

namespace plumb::compiler {

struct DoorwayOptions {
  double max_sill_m = 0.15;   // an opening without a door that begins higher above the floor is a hatch
  double min_height_m = 1.6;  // ... and one that is lower
  double min_width_m = 0.4;   // ... and one that is narrower
  double max_reach_m = 0.6;   // how far behind its wall's face a room is looked for: double walls, linings
  [[nodiscard]] std::string Check() const;
};

// The source element of each doorway and window, by position in graph.doorways and graph.windows.
struct OpeningElements {
  std::vector<std::vector<uint32_t>> of_doorway, of_window;
};

// Appends to graph.doorways: every door, and every unfilled opening through a wall that a person can walk through from one room to another
// or outside (once, where the layers of a wall are walls of their own, each with its opening). The rooms are found by probing away from the
// wall on both sides, past cavities and further walls up to max_reach_m. room_a is the room with the lower id; outside is always room_b.
// Appends to graph.windows: every window in a wall. Needs graph.walls and graph.rooms.
OpeningElements AddDoorwaysAndWindows(const PlanIr& plan, const FloorIr& floors, const RoomsByFace& rooms,
                                      const std::vector<HostedOpening>& openings, const DoorwayOptions& options, AGraph& graph,
                                      DiagnosticSink& sink);

}  // namespace plumb::compiler
