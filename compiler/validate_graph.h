// Checks of an A-Graph as a whole.
#pragma once

#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "schema/agraph.h"

namespace plumb::compiler {

// What no single pass and no reader can check: that rooms, surfaces and openings fit together, and that there is something to find oneself
// by. Ids must be in range, as in every A-Graph that the reader returns. Kinds 71xx, 72xx, 7001 and 8001. O(N log N) where few rooms
// overlap.
[[nodiscard]] std::vector<Diagnostic> ValidateGraph(const AGraph& graph);

}  // namespace plumb::compiler
