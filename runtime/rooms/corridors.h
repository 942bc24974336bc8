// Corridors: two walls that face each other along a room that has no end.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/rooms/free_space.h"
#include "runtime/rooms/outline.h"
#include "runtime/rooms/regions.h"
#include "runtime/rooms/rooms.h"

namespace plumb::runtime {

// Of one region: pairs of its outline's surfaces that are parallel within 5 degrees and face each other over 0.6 m to 5 m of the region's
// free space, along twice their distance or more. The longest first; none that lies in a longer one. Ids and rooms are left 0.
// O(surfaces^2).
[[nodiscard]] std::vector<MapCorridor> FindCorridors(const FreeSpace& space, const Regions& regions, int32_t region,
                                                     const Outline& outline);

}  // namespace plumb::runtime
