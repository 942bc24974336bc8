// Walls of one floor as they stand on it.
#pragma once

#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/rooms/free_space.h"
#include "runtime/rooms/range_profile.h"

namespace plumb::runtime {

// The stretches of the map's walls within the band, but for furniture (FindFreeSpace). `profiles`: of every keyframe, without rays where it
// belongs to another floor. O(wall cells + columns of low surfaces times their keyframes).
[[nodiscard]] std::vector<WallPiece> FindWallPieces(const SGraph& graph, const HeightBand& band, const std::vector<RangeProfile>& profiles);

}  // namespace plumb::runtime
