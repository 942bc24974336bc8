// The free space of a floor, parted at doors.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/rooms/free_space.h"
#include "runtime/rooms/room_options.h"

namespace plumb::runtime {

// Where two regions meet: the cell with most clearance there.
struct Neck {
  int32_t region_a = 0, region_b = 0;  // a < b
  size_t cell = 0;
};

struct Regions {
  static constexpr int32_t kNone = -1;

  int32_t count = 0;
  std::vector<int32_t> label;      // per cell
  std::vector<float> clearance_m;  // per cell, to the nearest cell that is not free; 0 there
  std::vector<Neck> necks;         // by regions, then cells
};

// A watershed of the clearance: cells join in descending order, and where two regions meet they become one unless they are rooms with a
// door between. With the width w of the neck where they meet (ShortestSpan) and the diameter D of the largest circle in the narrower of the
// two, they stay apart if something was seen at both ends of the neck, and
//   w <= door_width_m and D >= 1.5 w: a neck between wider spaces; or
//   w <= door_width_m and D >= 1.05 w and the neck is an opening in a wall (IsInWall): as wide as the door is many a corridor; or
//   w <= passage_width_m and D >= 1.3 w and the neck is an opening in a wall.
// Then regions smaller than min_room_area_m2 go to the neighbour that they have most border with. Regions are numbered by their first cell.
// O(cells + necks * walls).
[[nodiscard]] Regions FindRegions(const FreeSpace& space, const RoomOptions& options);

}  // namespace plumb::runtime
