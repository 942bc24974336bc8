// Walls built so far off their plan that the gates of the coupling miss them. Internal to coupling/.
#pragma once

#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/coupling/wall_frame.h"
#include "runtime/coupling/wall_patch.h"

namespace plumb::runtime {

// A wall that nothing was matched to, and how it would have to stand.
struct FarWall {
  WallId wall;
  WallDeviation deviation;
};

// `unmatched`: patches that no plan surface explains. `matched`: per plan wall. A wall is found far off only if the unmatched patch is as
// large as a wall, nothing is seen through it, and the planned place is proven empty: lines of sight go through it, or, for a patch in
// front of it, whose planned place nobody can see, the patch closes the room from end to end and up to the top as no furniture does. Patch
// and wall must be each other's best by far: with a rival for either, nothing is found. By wall. O(patches * surfaces).
[[nodiscard]] std::vector<FarWall> FindFarWalls(const AGraph& plan, const std::vector<WallFrame>& frames,
                                                const std::vector<Patch>& unmatched, const std::vector<bool>& matched,
                                                const std::vector<std::vector<WallOpening>>& openings, const SightLines& sight,
                                                const CouplingOptions& options);

}  // namespace plumb::runtime
