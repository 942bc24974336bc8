// The aliasing forecast (alias_forecast.h) in words.
#pragma once

#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "schema/agraph.h"

namespace plumb::compiler {

// kPlanAlias for each closed alias, kPartialAlias for the others, kRoomsAlike for the look-alikes, in the order of the graph.
[[nodiscard]] std::vector<Diagnostic> DescribeAliases(const AGraph& graph);

}  // namespace plumb::compiler
