// A doorway in a floor plan, with its leaves as an architect draws them.
#pragma once

#include <string>

#include "schema/agraph.h"
#include "tools/drawing/svg.h"

namespace plumb::tools {

inline constexpr double kUnknownThickness_m = 0.2;  // of walls that doorways and windows do not have

// As SVG elements: the opening, and for each leaf how it moves (swings with their arcs to one or both sides, panels that slide or fold,
// revolving doors, doors that lift). What the plan does not tell is drawn as is common: one leaf up to 1.4 m, else two; from outside
// inwards, from a corridor into the room, else into the smaller room; at the jamb nearer to a corner.
[[nodiscard]] std::string DrawDoor(const AGraph& graph, const Doorway& doorway, const Sheet& sheet);

}  // namespace plumb::tools
