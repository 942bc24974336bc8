// The house as built: planned walls left out, and walls that are in no plan.
#pragma once

#include "tools/simulate/as_built.h"

namespace plumb::tools {

// Takes out `count` walls between rooms of the storey, at least 1.5 m long, with all that they host; walls that deviate stay. Which ones
// follows from the seed. Errors: kPlanUnsuitable if there are not so many.
[[nodiscard]] Expected<void> LeaveOutWalls(const AGraph& plan, StoreyId storey, int count, uint64_t seed, AsBuilt& built);

// Adds `count` walls, 0.1 to 0.2 m thick and 1.2 to 2.5 m long, from floor to ceiling: each starts at a wall of a room and runs straight
// into it. Every room that could be reached still can, nothing stands in a doorway, and there is 0.7 m to the next wall or thing on either
// side. Errors: kPlanUnsuitable if there is no place for so many.
[[nodiscard]] Expected<void> AddWalls(const AGraph& plan, StoreyId storey, int count, uint64_t seed, AsBuilt& built);

// Rays that went through where the plan has a wall that was left out: from `from` to `to` (plan frame), right through its body.
[[nodiscard]] bool PassesThrough(const WallBody& body, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace plumb::tools
