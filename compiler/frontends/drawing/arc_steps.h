// The steps that arcs of a drawing are taken in.
#pragma once

#include "compiler/frontends/drawing/drawing.h"

namespace plumb::compiler {

// Divides the sides of paths that are steps along their exact arcs where they stand off them by more than `sagitta_m`. Sources read arcs
// before the unit is known, in steps of some share of the radius, which is much in walls of large radius. The drawing is in metres. Linear
// in sides times arcs of their path.
void RefineArcSteps(double sagitta_m, Drawing& drawing);

}  // namespace plumb::compiler
