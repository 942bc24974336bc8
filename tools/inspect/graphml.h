// The A-Graph's rooms, doorways and wall surfaces as a graph in GraphML (graphml.graphdrawing.org).
#pragma once

#include <string>

#include "schema/agraph.h"

namespace plumb::tools {

// Undirected. Nodes `room:3`, `doorway:1`, `surface:17` and, where a doorway leads there, `outside`; edges by their attribute `kind`:
// "joins" (doorway and room), "bounds" (surface and room), "open" (two rooms without a wall between them), "same wall" (two surfaces of one
// wall). Attributes as in the JSON form. With what yEd needs to show names, kinds as shapes, and everything where it lies in the plan, the
// storeys one above the other.
[[nodiscard]] std::string AGraphToGraphMl(const AGraph& graph);

}  // namespace plumb::tools
