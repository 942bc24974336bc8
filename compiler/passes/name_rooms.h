// Pass: names rooms after the source's spaces and reports where the two differ. Never makes, drops or changes a room.
#pragma once

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/ir/floor_ir.h"

namespace plumb::compiler {

struct NamingOptions {
  double min_name_iou = 0.4;   // intersection over union from which a space names a room
  double min_equal_iou = 0.9;  // below this the difference is reported
  [[nodiscard]] std::string Check() const;
};

// Sets Room::name and ::guid by the best overlap of the room with a section of a space at the same height, each space at most once.
// Rooms that no space names get "<storey> room <n>".
void NameRooms(const PlanIr& plan, const FloorIr& floors, const NamingOptions& options, AGraph& graph, DiagnosticSink& sink);

}  // namespace plumb::compiler
