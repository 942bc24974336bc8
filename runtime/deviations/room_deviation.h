// A room's motion, derived from its walls: rooms carry no measurements of their own.
#pragma once

#include <vector>

#include "runtime/deviations/deviations.h"

namespace plumb::runtime {

// Least squares of the rigid planar motion over both ends of every observed wall of the room, weighted by length; for a rectangle
// that is half the sum of opposite walls' displacements. `surfaces`: one per plan surface. Unobserved unless two directions were seen.
[[nodiscard]] RoomDeviation DeviationOfRoom(const AGraph& plan, RoomId room, const std::vector<SurfaceDeviation>& surfaces,
                                            const DeviationOptions& options);

}  // namespace plumb::runtime
