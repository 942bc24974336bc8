// Doorways that are drawn by their frames alone: two narrow boxes across a wall whose lines go on between them.
#pragma once

#include <vector>

#include "compiler/frontends/drawing/openings.h"

namespace plumb::compiler {

struct FramedDoorOptions {
  double min_width_m = 0.6, max_width_m = 2.4;
  double min_frame_m = 0.015, max_frame_m = 0.15;  // along the wall
  double beyond_m = 0.012;                         // from the piece's sides, past lines that were drawn twice
};

// In the order of the map's faces. A piece of wall between two frames, with free space on both sides and nothing drawn in it: a window has
// its sill or pane there.
[[nodiscard]] std::vector<DrawnOpening> FindFramedDoors(const Drawing& drawing, const WallMass& mass, const FramedDoorOptions& options = {});

}  // namespace plumb::compiler
