// The A-Graph as JSON, the form that `plumb inspect --json` prints.
#pragma once

#include <string>

#include "schema/agraph.h"

namespace plumb {

// One object with arrays storeys, walls, surfaces, rooms, doorways, windows, columns, open_boundaries. Every entry has id, guid (string or
// null), name, storey. Metres, radians, plan frame. Numbers are rounded to 0.1 mm (unit vectors to 1e-9); same graph, same text. No mesh.
[[nodiscard]] std::string AGraphToJson(const AGraph& graph);

}  // namespace plumb
