// truth.json of a simulated recording: what was built otherwise, and what the lidar saw of it.
#pragma once

#include <string>
#include <vector>

#include "tools/simulate/as_built.h"

namespace plumb::tools {

[[nodiscard]] std::string TruthToJson(const AGraph& plan, const SimulateOptions& options, const SimulateSummary& summary);

}  // namespace plumb::tools
