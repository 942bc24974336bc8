// Wall segments from planar scans.
#pragma once

#include <vector>

#include "runtime/mapping/keyframe_window.h"
#include "runtime/mapping/mapper_options.h"
#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// Height either side of the scan plane that a planar scan is taken to have seen of a wall.
inline constexpr double kSeenHalfHeight_m = 0.05;

// Height of the wall that such a line stands for where areas are weighed: what is straight for metres is rarely less high.
inline constexpr double kLineHeight_m = 1.0;

// Straight runs of the window's scans as vertical planes; the scan plane is level. Scans are split at gaps and where they bend (iterative
// end-point fit), runs of one line joined. How high a wall reaches is not seen: its points count as spread evenly to kSeenHalfHeight_m
// above and below the scan plane, which makes the plane vertical and leaves its tilt as uncertain as that height allows. In order of
// length. O(points log points).
[[nodiscard]] std::vector<Segment> ExtractLineSegments(const KeyframeWindow& window, const MapperOptions& options);

}  // namespace plumb::runtime
