// A drive through every room that can be reached: depth first through the doorways, again and again until it is long enough.
#pragma once

#include <vector>

#include "schema/error.h"
#include "tools/simulate/drive.h"
#include "tools/simulate/reach.h"

namespace plumb::tools {

struct TourOptions {
  DriveOptions drive;
  double min_duration_s = 120, max_duration_s = 900;
};

struct Tour {
  Drive drive;
  RoomId start_room;
  std::vector<RoomId> visited, not_visited;  // rooms of the storey
  double path_m = 0;
};

// Start room, start heading, order and viewpoints are random. Errors: kPlanUnsuitable (no room has a place for
// the robot, or none of several can be left through a doorway).
[[nodiscard]] Expected<Tour> PlanTour(const AGraph& house, const FreeSpace& space, const Reach& reach, const TourOptions& options,
                                      Random& random);

}  // namespace plumb::tools
