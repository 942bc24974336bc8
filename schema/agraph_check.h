// What the FlatBuffers verifier cannot know of an A-Graph: that ids point somewhere and numbers are numbers.
#pragma once

#include <cstddef>
#include <string>

#include "schema/agraph.h"

namespace plumb {

// The first fault found, with the entry that has it; empty if there is none. The mesh is not looked at.
[[nodiscard]] std::string FindFault(const AGraph& graph);

// The same of the triangles of a graph with so many elements.
[[nodiscard]] std::string FindMeshFault(const Mesh& mesh, size_t elements);

}  // namespace plumb
