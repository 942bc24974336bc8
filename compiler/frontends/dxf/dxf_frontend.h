// The DXF frontend: a drawing of R12 to 2018, text or binary, in; the plan as drawn out.
//
// dxflib reads the entities; blocks are unfolded here, layers get their meaning by rules (drawing/layer_rules.h), the unit is checked against
// what is drawn, and the walls are found by drawing/plan_from_drawing.h. What is not read is a diagnostic, never silence.
#pragma once

#include <string>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/drawing/plan_from_drawing.h"
#include "compiler/ir/plan_ir.h"
#include "compiler/source/source.h"

namespace plumb::compiler {

struct DxfOptions {
  DrawingOptions drawing;
  std::string unit;             // mm, cm, m, in, ft; empty: as the file states, if that is plausible
  std::string layers;           // a built-in set of layer rules or a TOML file; empty: the set that fits best
  int sheet = 0;                // of several plans on one sheet, from 1; 0: all of them, as storeys
  int max_block_depth = 16;
  size_t max_paths = 4'000'000;  // of all blocks unfolded
  [[nodiscard]] std::string Check() const;
};

// Appends the drawing's storey, or storeys, to `plan`, the lowest one at `storey.elevation_m`. False: no plan comes of it, and an error
// says so. Same bytes and options, same result.
[[nodiscard]] bool AppendDxf(const Source& source, const PlanStorey& storey, const DxfOptions& options, PlanIr& plan, DiagnosticSink& sink);

}  // namespace plumb::compiler
