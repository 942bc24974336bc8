// Pass PlanIr -> FloorIr, first half: which physical walls there are, and what they and the columns leave in the map of each level.
#pragma once

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/ir/floor_ir.h"
#include "compiler/passes/assign_storeys.h"

namespace plumb::compiler {

struct FootprintOptions {
  double grid_m = 1e-4;              // footprints are rounded to this grid: coordinates of one place in the source agree
  double closed_above_gap_m = 0.3;   // a wall below the section height bounds rooms if a roof or slab begins this close above its top
  double max_curtain_depth_m = 0.5;  // posts of a curtain wall within a band no deeper than this stand in a straight wall
  double max_holding_distance_m = 0.3;  // from a leaf or pane, square to it, to the wall that holds it; others close a gap between walls
  [[nodiscard]] std::string Check() const;
};

// A wall, a curtain wall or a proxy with an uncut solid. Elements of one guid are one wall.
[[nodiscard]] std::vector<PlanWall> CollectWalls(const PlanIr& plan);

// Sections of walls and columns on every level; the planar maps stay empty (planar_map.h). A solid is in the map of each level whose
// section plane it crosses. A wall that crosses none is cut at its own middle on the level of its storey, and bounds rooms only if it is
// closed above (a knee wall under a roof): parapets, balustrades and walls that hang from the ceiling do not. On a level with knee walls
// every footprint is the union of the sections at the section height and at the knee walls' middles, since a roof may narrow walls further
// up. Curtain walls cover the band that their posts stand in. Doors and windows that stand in no wall bound rooms themselves.
[[nodiscard]] FloorIr CutFootprints(const PlanIr& plan, const std::vector<Level>& levels, const FootprintOptions& options,
                                    DiagnosticSink& sink);

}  // namespace plumb::compiler
