// The storeys that the robot was on.
#pragma once

#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/rooms/room_options.h"
#include "runtime/rooms/rooms.h"

namespace plumb::runtime {

// A floor is where the robot settled: a stretch of keyframes at one height, 2 m wide or more, storey_step_m or more above or below every
// other floor, and, if the map has floor surfaces at all, with one underneath. Stairs, landings, ramps and lifts belong to the nearest
// floor. In ascending order; one at least if there are keyframes. O(keyframes + observations).
[[nodiscard]] std::vector<MapFloor> FindFloors(const SGraph& graph, const RoomOptions& options);

}  // namespace plumb::runtime
