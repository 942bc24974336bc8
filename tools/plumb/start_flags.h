// --near, --room and --mount of `plumb localize`: what is known of how it starts.
#pragma once

#include <Eigen/Core>
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

// `mount`: "ROLL,PITCH" of the lidar on the robot in degrees, first about x, then about the robot's y; may be empty: upright. The unit
// vector away from gravity in the lidar's frame. Errors: kBadOption (not numbers).
[[nodiscard]] Expected<Eigen::Vector3d> ParseMount(const std::string& mount);

}  // namespace plumb::tools
