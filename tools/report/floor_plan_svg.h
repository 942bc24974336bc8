// One storey drawn as a floor plan: walls cut at 1.1 m and filled, doors with their swing, windows, stairs, rooms with name and area.
#pragma once

#include <string>

#include "schema/agraph.h"
#include "tools/report/svg.h"

namespace plumb::tools {

inline constexpr double kSectionHeight_m = 1.1;  // above the storey's zero, as floor plans are cut

// Style sheet for the classes that the drawing uses; colours are CSS variables with the light scheme as default.
[[nodiscard]] std::string FloorPlanStyle();

// The sheet that holds the whole storey.
[[nodiscard]] Sheet SheetOf(const AGraph& graph, StoreyId storey);

// The drawing as SVG elements for that sheet: what lies under and what lies over further layers.
[[nodiscard]] std::string DrawFloorPlan(const AGraph& graph, StoreyId storey, const Sheet& sheet);
[[nodiscard]] std::string DrawRoomLabels(const AGraph& graph, StoreyId storey, const Sheet& sheet);
[[nodiscard]] std::string DrawScaleBar(const Sheet& sheet);

// A whole SVG file of one storey; `storey` must exist.
[[nodiscard]] std::string FloorPlanToSvg(const AGraph& graph, StoreyId storey);

}  // namespace plumb::tools
