// Names and areas of rooms, where they fit.
#pragma once

#include <string>

#include "schema/agraph.h"
#include "tools/drawing/svg.h"

namespace plumb::tools {

// Over the floor plan, in its style: each room's name, broken into two lines or turned upright where that lets it be
// larger, and its area. Labels that would cross are moved, or do without the area. Made names (of rooms without a space) are left out where
// they do not fit.
[[nodiscard]] std::string DrawRoomLabels(const AGraph& graph, StoreyId storey, const Sheet& sheet);

}  // namespace plumb::tools
