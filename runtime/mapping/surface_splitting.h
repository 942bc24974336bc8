// Two walls that wrong poses had laid on each other come apart again when the poses are put right.
#pragma once

#include <optional>
#include <vector>

#include "runtime/mapping/map_surfaces.h"

namespace plumb::runtime {

// Parts a surface whose views do not lie on one plane, by the keyframes' present poses: into those that do and those that lie on another,
// which are returned as a surface without id. None, and nothing changed: one plane fits, as FitOnePlane() has it but with a margin, so that
// what was parted does not merge again at once; or no two planes, each seen from two keyframes or more, do. Cells go where the views
// nearest to them went. Requires plane and sum of the present poses (Recompute). O(views (views + cells)), as a rule O(views).
[[nodiscard]] std::optional<TrackedSurface> SplitOff(const std::vector<Keyframe>& keyframes, const MapperOptions& options,
                                                     MapSurface* surface, SurfaceTrack* track);

}  // namespace plumb::runtime
