// The house as built: the plan with some walls displaced, left out or added.
#pragma once

#include <vector>

#include "tools/simulate/doorway_changes.h"
#include "tools/simulate/free_space.h"
#include "tools/simulate/reach.h"
#include "tools/simulate/simulate.h"
#include "tools/simulate/wall_geometry.h"

namespace plumb::tools {

// A wall that is in no plan.
struct AddedWall {
  Rectangle footprint;
  double height_m = 0;
  uint32_t element = 0;  // of AsBuilt::house
};

struct AsBuilt {
  AGraph house;                            // inner doors open; mesh as built, structure (rooms, surfaces, doorways) as planned
  std::vector<Eigen::Isometry2d> motions;  // of each plan wall, plan frame
  std::vector<WallDisplacement> walls;     // those that moved
  std::vector<WallId> missing;             // planned walls that are not there, ascending
  std::vector<AddedWall> unplanned;
  std::vector<Doorway> doorways;           // of the plan, where they are cut into the walls as planned
  std::vector<DoorwayChange> doorway_changes;
  std::vector<Rectangle> passages;         // the floor of the doorways between rooms of the storey
};

// Moves options.deviate (or deviate_ratio of the) walls that bound a room of the storey with at least 1.5 m. Which ones and how far follows
// from the seed. In every direction of walls most stay put (so that the plan's frame remains), no wall runs into another, into an opening
// or away from a joint, every room that could be reached still can, and no ray leaves a room where none left before. Errors:
// kPlanUnsuitable if there are not so many such walls.
[[nodiscard]] Expected<AsBuilt> BuildWithDeviations(const AGraph& plan, StoreyId storey, const SimulateOptions& options);

// The doorways in straight walls of the storey that stand.
[[nodiscard]] std::vector<BuiltDoorway> DoorwaysOf(const AGraph& plan, StoreyId storey, const AsBuilt& built);

// What the motion of its wall makes of a surface.
[[nodiscard]] SurfaceDisplacement DisplacementOf(const AGraph& plan, SurfaceId surface, const Eigen::Isometry2d& motion);

}  // namespace plumb::tools
