// Checks of a whole A-Graph that no single pass and no reader can make: that its rooms, surfaces and openings fit together.
#pragma once

#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "schema/agraph.h"

namespace plumb::compiler {

// Ids must be in range, as in every A-Graph that the reader returns. Kinds 71xx, 72xx, 7001 and 8001. Rooms are compared in pairs per storey.
[[nodiscard]] std::vector<Diagnostic> ValidateGraph(const AGraph& graph);

}  // namespace plumb::compiler
