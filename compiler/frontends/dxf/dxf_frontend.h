// The DXF frontend: a drawing of R12 to 2018, text or binary, in; the plan as drawn out.
//
// dxflib reads the entities; blocks are unfolded here, layers get their meaning by rules (drawing/layer_rules.h), the unit is checked
// against what is drawn, and the walls are found by drawing/plan_from_drawing.h. What is not read is a diagnostic, never silence.
#pragma once

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/drawing/drawing_file.h"
#include "compiler/ir/plan_ir.h"
#include "compiler/source/source.h"

namespace plumb::compiler {

// Appends the drawing's storey, or storeys, to `plan`, the lowest one at `storey.elevation_m`. False: no plan comes of it, and an error
// says so. Same bytes and options, same result.
[[nodiscard]] bool AppendDxf(const Source& source, const PlanStorey& storey, const DrawingFileOptions& options, PlanIr& plan,
                             DiagnosticSink& sink);

}  // namespace plumb::compiler
