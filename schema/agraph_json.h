// The A-Graph as JSON, the form that `plumb inspect --json` prints.
#pragma once

#include <string>

#include "schema/agraph.h"

namespace plumb {

[[nodiscard]] const char* NameOf(LeafOperation operation);  // "swing", "double-acting", ...; "unknown"

// One object with arrays storeys, walls, surfaces, rooms, doorways, windows, columns, open_boundaries. Every entry has id, guid (string or
// null), name, storey. Metres, radians, plan frame. Numbers are rounded to 0.1 mm (unit vectors to 1e-9); same graph, same text. No mesh.
// A leaf of a doorway: `operation` as NameOf gives it, `jamb` "left" or "right" of someone who passes from rooms[0] to rooms[1], `opens_to`
// 0 or 1 for the one of `rooms`, `width_m`; null where the plan does not tell. `leaves` is empty where nothing is known of them.
[[nodiscard]] std::string AGraphToJson(const AGraph& graph);

}  // namespace plumb
