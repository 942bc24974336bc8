// Which rooms of a storey a robot reaches from each other, and how wide it may be.
#pragma once

#include <vector>

#include "tools/simulate/free_space.h"

namespace plumb::tools {

// The part of a room that a robot drives about in: its largest connected piece of free floor.
struct RoomFloor {
  RoomId room;
  std::vector<size_t> cells;  // ascending; empty: no place to stand
  size_t middle = 0;          // the cell with the largest clearance
  bool reachable = false;     // from the largest group of rooms that are reachable from each other
};

struct Reach {
  double robot_radius_m = 0;
  std::vector<RoomFloor> rooms;  // those of the storey, ascending
  [[nodiscard]] size_t reachable() const;
};

// The robot has a radius of 0.25 m, or as much less (down to 0.12 m) as it takes to reach the most rooms. O(area).
[[nodiscard]] Reach FindReach(const AGraph& house, StoreyId storey, const FreeSpace& space);
// For a robot of this radius.
[[nodiscard]] Reach ReachWithRadius(const AGraph& house, StoreyId storey, const FreeSpace& space, double radius_m);

}  // namespace plumb::tools
