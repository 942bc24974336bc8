// Floors and ceilings of plans that have walls only: drawings, and models whose slabs were left out. The house that is built has them.
#pragma once

#include <vector>

#include "schema/agraph.h"
#include "tools/simulate/rectangle.h"

namespace plumb::tools {

// `house` with flat floors at the levels of the storey's rooms, and in `passages`, if under most of what the rooms cover there is none
// within half a metre; and with flat ceilings if above most of it there is nothing. Rooms that have one keep it: stair halls in a storey
// with floors stay open. O(area * log triangles).
[[nodiscard]] AGraph WithFloorsAndCeilings(AGraph house, StoreyId storey, const std::vector<Rectangle>& passages);

}  // namespace plumb::tools
