// An A-Graph in words.
#pragma once

#include <string>

#include "schema/agraph.h"

namespace plumb::tools {

// Where it comes from, how much is in it, and storey by storey its rooms and the doorways between them.
[[nodiscard]] std::string AGraphToText(const AGraph& graph);

}  // namespace plumb::tools
