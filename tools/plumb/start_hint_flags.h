// --near and --room of `plumb localize`.
#pragma once

#include <string>
#include <vector>

#include "runtime/matching/start_hint.h"
#include "schema/agraph.h"
#include "schema/error.h"

namespace plumb::tools {

// `near`: "X,Y[,SIGMA]" in metres of the plan frame, may be empty; `rooms`: what FindRooms takes (tools/inspect/rooms.h).
// Errors: kBadOption (not numbers; out of range; far off the plan; no such room, with the nearest name).
[[nodiscard]] Expected<runtime::StartHint> ParseStartHint(const std::string& near, const std::vector<std::string>& rooms,
                                                          const AGraph& plan);

}  // namespace plumb::tools
