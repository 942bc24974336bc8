// Pass: open plans that the source names in parts are divided along its spaces. Rooms never depend on spaces: without any, or with
// spaces that contradict the walls, an open plan stays the one room that its walls make it.
#pragma once

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/ir/floor_ir.h"
#include "compiler/passes/planar_map.h"

namespace plumb::compiler {

struct DivideOptions {
  bool divide = true;              // false: an open plan stays the one room that its walls make it, whatever spaces the source names in it
  double min_inside_share = 0.9;   // of a space's area beside walls that lies within the open plan, for the space to divide it
  double max_overlap_share = 0.1;  // of the smaller of two spaces; a space that overlaps others by more is a zone of several
  double min_area_m2 = 1.0;        // smaller spaces divide nothing
  [[nodiscard]] std::string Check() const;
};

// The outline of a space where the walls of its level are cut. Empty if the space has no solid there.
[[nodiscard]] std::vector<Ring> SpaceOutline(const PlanSpace& space, const Floor& floor);

// The floor of a storey.
[[nodiscard]] size_t FloorOfStorey(const FloorIr& floors, uint32_t storey);

// Where two or more spaces that do not overlap lie within one free face: sets Floor::dividers and builds the map anew. A space that no wall
// bounds anywhere divides nothing. Errors: kInternal.
[[nodiscard]] Expected<void> DivideRooms(const PlanIr& plan, const DivideOptions& options, const PlanarMapOptions& map_options,
                                         FloorIr& floors, DiagnosticSink& sink);

// Appends to graph.open_boundaries the lines along which rooms of an open plan meet.
void AddOpenBoundaries(const FloorIr& floors, const std::vector<std::vector<RoomId>>& rooms_by_face, AGraph& graph);

}  // namespace plumb::compiler
