// truth.json of a simulated recording: what was built otherwise, and what the lidar saw of it.
#pragma once

#include <string>
#include <vector>

#include "tools/simulate/as_built.h"

namespace plumb::tools {

// `surface_points`: returns from each plan surface.
[[nodiscard]] std::string TruthToJson(const AGraph& plan, const SimulateOptions& options, const SimulateSummary& summary,
                                      const std::vector<uint64_t>& surface_points);

}  // namespace plumb::tools
