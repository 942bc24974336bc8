// Where a robot that was not found may be: the places that the last try left open, on the floor plan and as a table.
#pragma once

#include <string>

#include "schema/agraph.h"
#include "tools/drawing/svg.h"
#include "tools/run/tries_json.h"

namespace plumb::tools {

[[nodiscard]] std::string PlaceStyle();

// Numbered arrows, best first, as in the table; those of one storey.
[[nodiscard]] std::string DrawPlaces(const AGraph& plan, StoreyId storey, const TryRow& attempt, const Sheet& sheet);

// With the advice where to drive. Empty if no place is left.
[[nodiscard]] std::string PlacesHtml(const TryRow& attempt);

}  // namespace plumb::tools
