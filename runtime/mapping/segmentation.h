// Planar segments of a keyframe.
#pragma once

#include <vector>

#include "runtime/mapping/keyframe_window.h"
#include "runtime/mapping/mapper_options.h"
#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// Walls within 15 degrees of vertical, floors and ceilings within 15 degrees of level; other planes are left out. Surfels grow into
// regions, those with most points first; then every point in the band about a region's plane, seen from its free side, goes to the nearest
// region, and planes are fitted to these (cell_planes.h). What is then near none is tried again with larger surfels: walls that are so far
// away that the scans' rings are further apart than the first surfels are wide. A point counts once. In order of the regions' sizes.
// O(points).
[[nodiscard]] std::vector<Segment> ExtractSegments(const KeyframeWindow& window, const MapperOptions& options);

}  // namespace plumb::runtime
