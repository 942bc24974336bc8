// Segments that no wall is: planes through the noise between a surface and what stands a hand's breadth before or behind it.
#pragma once

#include <vector>

#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// Drops each segment that leans by a few degrees from a larger one of its kind, starting on it, while most of its cells are within the
// larger one's noise and next to its cells: it joins that surface to another one, as a pillar that stands out of the wall by less than its
// noise reaches. Walls that really meet at such an angle go on past the larger one's end; under 0.6 m they may be dropped, too. Keeps the
// order. O(cells of both) for every pair that leans.
void DropBridges(std::vector<Segment>* segments);

}  // namespace plumb::runtime
