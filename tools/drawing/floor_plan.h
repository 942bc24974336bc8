// One storey drawn as a floor plan: walls cut at 1.1 m and filled, doors with their swing, windows, stairs.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "schema/agraph.h"
#include "tools/drawing/svg.h"

namespace plumb::tools {

inline constexpr double kSectionHeight_m = 1.1;  // above the storey's zero, as floor plans are cut

// Style sheet for the classes that the drawing uses; colours are CSS variables with the light scheme as default.
[[nodiscard]] std::string FloorPlanStyle();

// Along the surface from start to end: its two ends, or points on its arc at most 2 degrees apart.
[[nodiscard]] Ring PointsAlong(const Surface& surface);

// What the storey's walls, surfaces and rooms cover, plan frame, metres; empty where it has none.
[[nodiscard]] Eigen::AlignedBox2d BoundsOf(const AGraph& graph, StoreyId storey);

// A sheet at 1:100 that holds the whole storey.
[[nodiscard]] Sheet SheetOf(const AGraph& graph, StoreyId storey);

// The drawing as SVG elements for that sheet.
[[nodiscard]] std::string DrawFloorPlan(const AGraph& graph, StoreyId storey, const Sheet& sheet);

}  // namespace plumb::tools
