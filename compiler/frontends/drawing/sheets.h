// Several plans in one drawing, side by side.
#pragma once

#include <vector>

#include "compiler/frontends/drawing/drawing.h"

namespace plumb::compiler {

struct SheetOptions {
  double min_gap_m = 1.5;         // between plans
  double min_side_m = 4;          // smaller groups are details and legends
  double max_size_difference = 0.3;  // of sides, between plans of one building
};

// Groups of lines of about the same size with nothing between them, from left to right and below to above, all moved so that their lower
// left corners lie over that of the first. One if the groups differ: they are then parts of one storey, left where they are.
[[nodiscard]] std::vector<Drawing> SplitSheets(Drawing drawing, const SheetOptions& options = {});

// Layers of doors with long double lines have walls on them as well: their straight lines may be anything.
void MendRoles(Drawing& drawing);

}  // namespace plumb::compiler
