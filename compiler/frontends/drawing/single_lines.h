// Walls that are drawn as one line. Private to wall_mass.cc.
#pragma once

#include <vector>

#include "compiler/frontends/drawing/curve_edges.h"

namespace plumb::compiler {

struct WidenedLines {
  std::vector<MapLine> lines;                          // those that are no single ones as they are, and all outlines
  std::vector<std::vector<Eigen::Vector2d>> outlines;  // of the walls, closed
  std::vector<SourcedArc> arcs;                        // their curved sides
};

// Gives lines a thickness: each becomes a box, or a strip along the one of `arcs` that nearly all of it follows, half a thickness longer at
// ends that others meet, so that corners close. `is_single`: by edge of the map.
[[nodiscard]] WidenedLines WidenSingleLines(const LineMap& map, const std::vector<bool>& is_single, const std::vector<SourcedArc>& arcs,
                                            const MassOptions& options);

}  // namespace plumb::compiler
