// Dimension lines around a floor plan: over all, and along each facade the openings in it.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "schema/agraph.h"
#include "tools/drawing/svg.h"

namespace plumb::tools {

// The direction that most of the storey's walls have, up to quarter turns, in (-pi/4, pi/4]; 0 where it has none.
[[nodiscard]] double MainDirection(const AGraph& graph, StoreyId storey);

// The least rectangle in that direction around the outer walls, but those that stand by themselves and are under 1 m in size: posts, strays
// of the drawing. `size` is empty where the storey has no walls.
struct OuterRectangle {
  Eigen::Vector2d u = Eigen::Vector2d::UnitX(), v = Eigen::Vector2d::UnitY();
  Eigen::AlignedBox2d size;  // along u and v
  [[nodiscard]] Eigen::Vector2d At(double along_u, double along_v) const { return along_u * u + along_v * v; }
};
[[nodiscard]] OuterRectangle OuterRectangleOf(const AGraph& graph, StoreyId storey);

// One line of dimensions: measures between stops, along a side of the building.
struct DimensionChain {
  Eigen::Vector2d along, outward;  // unit vectors
  double outward_m = 0;            // of the building's side, along `outward`
  std::vector<double> stops_m;     // ascending, along `along`
  int row = 0;                     // 0 next to the building
};
[[nodiscard]] std::vector<DimensionChain> DimensionsOf(const AGraph& graph, StoreyId storey);

// How far outside the building the outermost row needs the sheet to reach, in units of the sheet.
inline constexpr double kDimensionDepth = 200;

[[nodiscard]] std::string DrawDimensions(const AGraph& graph, StoreyId storey, const Sheet& sheet);

}  // namespace plumb::tools
