// Doorways that are elsewhere, or of another width, on the floor plan and as a table.
#pragma once

#include <string>

#include "schema/agraph.h"
#include "tools/drawing/svg.h"
#include "tools/run/run_folder.h"

namespace plumb::tools {

[[nodiscard]] std::string DoorwayStyle();

// The opening as built, across its wall where that stands, of doorways that deviate; those that are walled up crossed out; with what is off beside them. The
// ids must exist in `plan`.
[[nodiscard]] std::string DrawDoorways(const AGraph& plan, StoreyId storey, const Deviations& deviations, const Sheet& sheet);

// Deviated ones first, by size. Empty if the run measured none.
[[nodiscard]] std::string DoorwayTable(const AGraph& plan, const Deviations& deviations);

}  // namespace plumb::tools
