// Pass: walls that do not quite meet. Gaps too narrow for anybody to pass are bridged where they would join two rooms, or a room and the
// outside.
#pragma once

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/ir/floor_ir.h"
#include "compiler/passes/planar_map.h"

namespace plumb::compiler {

struct BridgeOptions {
  double max_gap_m = 0.2;  // between two walls, a wall and a column ...: wider ones are passages
  [[nodiscard]] std::string Check() const;
};

// Lines from the corners of outlines to the nearest point of each other outline within max_gap_m through free space. Segments sorted along
// x: O(n log n + pairs that overlap along x).
[[nodiscard]] std::vector<Bridge> FindBridges(const Floor& floor, double min_gap_m, double max_gap_m);

// Builds the floor's planar map with the bridges that keep rooms apart and no others: a slit that only leads to a nook stays open, and so
// does one around a pier. Faces no wider than the gap are no rooms. Errors: kInternal.
[[nodiscard]] Expected<void> BridgeGaps(const BridgeOptions& options, const PlanarMapOptions& map_options, Floor& floor);

// One diagnostic for each gap that stays bridged.
void ReportBridges(const PlanIr& plan, const FloorIr& floors, DiagnosticSink& sink);

}  // namespace plumb::compiler
