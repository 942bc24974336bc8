// The house as built: doorways that are elsewhere in their wall than planned, or of another width.
#pragma once

#include <vector>

#include "tools/simulate/simulate.h"
#include "tools/simulate/wall_geometry.h"

namespace plumb::tools {

// A doorway that is cut elsewhere into its wall. The wall's own frame: along = (-sin, cos) of the doorway's yaw.
struct DoorwayChange {
  DoorwayId doorway;
  double shift_m = 0;            // of its middle, + along
  double width_deviation_m = 0;  // + wider
};

// Cuts `count` doorways between rooms of the storey (or `ratio` of those that may be changed, if positive) by
// options.min_doorway_m to max_doorway_m elsewhere: shifted, narrower or wider, or both. Their frames go with the jambs. In the triangles of
// `house`, whose walls stand as planned; `doorways` becomes as built. Which ones and how far follows from the seed. No jamb comes within
// 10 cm of another opening or another wall, and what is left is 0.7 m wide. By doorway. Errors: kPlanUnsuitable if there are not so many.
[[nodiscard]] Expected<std::vector<DoorwayChange>> ChangeDoorways(StoreyId storey, const SimulateOptions& options,
                                                                  const std::vector<WallBody>& bodies, AGraph& house,
                                                                  std::vector<Doorway>& doorways);

// Cuts the one doorway: the wall beside it is taken out within `reach_m` of the planned jambs and built up again to where they are now.
void CutDoorway(const DoorwayChange& change, double reach_m, AGraph& house);

}  // namespace plumb::tools
