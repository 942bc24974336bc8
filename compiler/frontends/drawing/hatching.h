// Hatching that was exported as lines: it is no wall, however close its lines are.
#pragma once

#include "compiler/frontends/drawing/drawing.h"

namespace plumb::compiler {

struct HatchingOptions {
  size_t min_lines = 6;             // beside each other
  double max_spacing_share = 0.03;  // of the drawing's extent
  // Of lines along or across most others, by a pen that draws other things, too. 0: the drawing's unit is not known yet.
  double max_spacing_m = 0.45;
  double own_pen_share = 0.9;    // of what a pen draws, for it to be one for hatching
  double max_difference = 0.08;  // of the spacing, between neighbours
  double min_overlap = 0.5;      // of the shorter line, along it
};

// Takes out the lines of one layer, but for those that are said to be walls, that lie beside each other at equal distances, whatever the
// unit: hatching and the treads of stairs; with them all others of their layer and direction, if they are most of these. Returns how many.
// O(n log n) for drawings whose lines do not all lie over each other.
size_t DropHatching(Drawing& drawing, const HatchingOptions& options = {});

}  // namespace plumb::compiler
