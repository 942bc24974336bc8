// Walls that were seen once, and not again where they should have been.
#pragma once

#include <vector>

#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// Whether a wall is a mere glimpse: short, seen from a single keyframe, while several others had `at`, its middle, before them from as near
// and as straight on. Most such planes lie over what is none, stairs, chairs or the reveals of a window; others were a leaf or a chair that
// has moved since. Real ones among them stood behind something else. O(keyframes).
[[nodiscard]] bool IsGlimpse(const MapSurface& surface, const Eigen::Vector3d& at, const std::vector<Keyframe>& keyframes);

}  // namespace plumb::runtime
