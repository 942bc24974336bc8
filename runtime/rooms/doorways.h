// The openings between rooms, measured.
#pragma once

#include <optional>

#include "runtime/rooms/free_space.h"
#include "runtime/rooms/regions.h"
#include "runtime/rooms/room_options.h"

namespace plumb::runtime {

struct Opening {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // middle, within its wall's thickness too
  double yaw_rad = 0;                                  // of the passage, from neck.region_a to neck.region_b
  double width_m = 0;
};

// The opening at a neck: square to the walls beside it and midway between their two faces; where they were not seen, square to the
// narrowest span and in the middle of where it is narrow. None if it is no doorway: narrower than min_doorway_width_m or wider than
// passage_width_m.
[[nodiscard]] std::optional<Opening> MeasureOpening(const FreeSpace& space, const Regions& regions, const Neck& neck,
                                                    const RoomOptions& options);

}  // namespace plumb::runtime
