// One storey drawn as a floor plan: walls cut and filled, doors with their leaves, windows, stairs.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "schema/agraph.h"
#include "tools/drawing/svg.h"

namespace plumb::tools {

struct FloorPlanOptions {
  double section_height_m = 1.1;  // of the cut above the storey's zero: over sills, under lintels, as is common
  // Empty if every field is valid; else names the field, its value and the rule.
  [[nodiscard]] std::string Check() const;
};

// Where the storey is cut, above its zero: as asked for, but below the highest of its ceilings, over which there are roofs, no rooms;
// without rooms, below the top of its walls.
[[nodiscard]] double SectionHeight(const AGraph& graph, StoreyId storey, const FloorPlanOptions& options);

// Style sheet for the classes that the drawing uses; colours are CSS variables with the light scheme as default.
[[nodiscard]] std::string FloorPlanStyle();

// Along the surface from start to end: its two ends, or points on its arc at most 2 degrees apart.
[[nodiscard]] Ring PointsAlong(const Surface& surface);

// What the storey's walls, surfaces and rooms cover, plan frame, metres; empty where it has none.
[[nodiscard]] Eigen::AlignedBox2d BoundsOf(const AGraph& graph, StoreyId storey);

// A sheet at 1:100 that holds the whole storey.
[[nodiscard]] Sheet SheetOf(const AGraph& graph, StoreyId storey);

// The drawing as SVG elements for that sheet.
[[nodiscard]] std::string DrawFloorPlan(const AGraph& graph, StoreyId storey, const Sheet& sheet, const FloorPlanOptions& options = {});

}  // namespace plumb::tools
