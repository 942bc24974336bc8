// Walls that are drawn as thick strokes among thin ones.
#pragma once

#include "compiler/frontends/drawing/drawing.h"

namespace plumb::compiler {

struct StrokeOptions {
  double min_thickness_m = 0.05, max_thickness_m = 0.65;
  double min_ratio = 1.8;          // to the thinnest stroke, where layers do not tell walls
  double min_length_share = 0.1;   // of all strokes, to be the walls of a drawing
};

// Turns every open stroke, or unfilled outline, that is as thick as a wall into the outlines of a wall that thick: on layers of walls all
// of them; where no layer has walls, those much thicker than others, which then are no walls. The drawing is in metres. O(n).
void WidenStrokes(Drawing& drawing, const StrokeOptions& options = {});

}  // namespace plumb::compiler
