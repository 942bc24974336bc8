// Which rooms are meant.
#pragma once

#include <string>
#include <vector>

#include "schema/agraph.h"
#include "schema/error.h"

namespace plumb::tools {

// By source id or name, else by name without regard to case and accents ("Kueche" and "kuche" for "Küche"), else by some words of it
// ("Kueche" for "6 Küche"): all that fit the first of these that fits any. Errors: kBadOption, with the nearest names, or those that there
// are.
[[nodiscard]] Expected<std::vector<RoomId>> FindRooms(const AGraph& graph, const std::string& name);

}  // namespace plumb::tools
