// What there is to say about the walls that were found in a drawing. Private to plan_from_drawing.cc.
#pragma once

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/drawing/wall_mass.h"

namespace plumb::compiler {

// Slips that were healed, outlines that stayed open so that their walls are lost, single lines and lines without a partner, each with its
// place: in the source, and in metres in the plan.
void ReportWalls(const Drawing& drawing, const WallMass& mass, const MassOptions& options, DiagnosticSink& sink);

}  // namespace plumb::compiler
