// An A-Graph in words.
#pragma once

#include <cstddef>
#include <string>

#include "schema/agraph.h"

namespace plumb::tools {

// Where it comes from, how much is in it, and storey by storey its rooms and the doorways between them. `triangles` is how many it has: its
// own mesh need not be loaded.
[[nodiscard]] std::string AGraphToText(const AGraph& graph, size_t triangles);

}  // namespace plumb::tools
