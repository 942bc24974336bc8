// Whole SVG files of floor plans, to scale, for print.
#pragma once

#include <string>
#include <vector>

#include "schema/agraph.h"
#include "tools/drawing/floor_plan.h"
#include "tools/drawing/svg.h"

namespace plumb::tools {

// Storeys that have something to draw, in the order of the plan.
[[nodiscard]] std::vector<StoreyId> DrawnStoreys(const AGraph& graph);

// One drawing below the other, all at the one of the usual scales (1:50, 1:100, 1:200, 1:500, ...) at which each fits on a sheet of A3:
// floor plan, dimension lines, rooms with name and area, title, scale bar, and north where it is known. `storeys` must exist. Millimetres
// are the file's unit, so that it prints to scale; no CSS variables, which most drawing programs do not know. Same graph, same text.
[[nodiscard]] std::string FloorPlansToSvg(const AGraph& graph, const std::vector<StoreyId>& storeys, const FloorPlanOptions& options = {});

// A bar of some centimetres, for a whole number of metres, its upper left corner at (x, y).
[[nodiscard]] std::string DrawScaleBar(const Sheet& sheet, double x, double y);

}  // namespace plumb::tools
