// The robot's way on the floor plan: coloured by time where it was localized, dashed where it was not.
#pragma once

#include <string>

#include "schema/agraph.h"
#include "tools/drawing/svg.h"
#include "tools/run/run_folder.h"

namespace plumb::tools {

[[nodiscard]] std::string TrajectoryStyle();

// The storey whose height band holds the pose; the nearest one outside all. `graph` must have a storey.
[[nodiscard]] StoreyId StoreyAt(const AGraph& graph, double z_m);

// The smoothed way on one storey, with its start, its end and the place of the first fix.
[[nodiscard]] std::string DrawTrajectory(const AGraph& graph, StoreyId storey, const Run& run, const Sheet& sheet);

}  // namespace plumb::tools
