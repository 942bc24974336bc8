// The SVG frontend: a floor plan as CubiCasa, Inkscape, Illustrator and CAD programs write it in; the plan as drawn out.
//
// Groups get their meaning by their layer labels, classes and ids through the same rules as the layers of other drawings; walls, openings
// and names are found by drawing/plan_from_drawing.h. The plan frame has the file's x, and its y turned up; SVG has no scale of its own, so
// that it is given, stated by the page, or seen in doors and walls. What is not read is a diagnostic, never silence.
#pragma once

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/drawing/drawing_file.h"
#include "compiler/ir/plan_ir.h"
#include "compiler/source/source.h"

namespace plumb::compiler {

// Appends the drawing's storey, or storeys, to `plan`, the lowest one at `storey.elevation_m`. False: no plan comes of it, and an error
// says so. Same bytes and options, same result. Nothing outside the file is read.
[[nodiscard]] bool AppendSvg(const Source& source, const PlanStorey& storey, const DrawingFileOptions& options, PlanIr& plan,
                             DiagnosticSink& sink);

}  // namespace plumb::compiler
