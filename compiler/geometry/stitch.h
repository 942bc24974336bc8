// From polygons that touch along their edges to a solid that fits corner to corner.
#pragma once

#include <vector>

#include "compiler/geometry/solid.h"
#include "compiler/geometry/triangulate.h"

namespace plumb::compiler {

// Triangulates polygons so that no corner of one lies inside an edge of another: corners closer than `tolerance_m` become one, and each
// that lies within it of an edge becomes a corner there too, but for edges that other polygons run along as often the one way as the other:
// these fit already. Polygons whose edges cover each other so end as a closed solid (IsClosed). O(n log n) for polygons of like size.
[[nodiscard]] Solid StitchPolygons(const std::vector<Ring3>& polygons, double tolerance_m);

}  // namespace plumb::compiler
