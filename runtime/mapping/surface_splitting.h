// Two walls that wrong poses had laid on each other come apart again when the poses are put right (runtime/METHOD.md, Splitting).
#pragma once

#include <optional>
#include <vector>

#include "runtime/mapping/map_surfaces.h"

namespace plumb::runtime {

// Whether the views of both together, as one surface, lie on two planes rather than one by the keyframes' present poses. Depends on views
// and poses alone: surfaces of which this holds must not merge, and what was merged without it does not split until either changes.
// O(views log views).
[[nodiscard]] bool LieOnTwoPlanes(const MapSurface& a, const MapSurface& b, const std::vector<Keyframe>& keyframes,
                                  const MapperOptions& options);

// Splits a surface whose views lie on two planes and returns the part with fewer points, without an id. None, and nothing changed, if they
// do not, if a part would be too small for a surface, or if one would hide the other: then poses differ that should not, or a thing has
// moved, and one surface is the better guess. Each part has its views' points, and of every cell as many views as saw it there, by the
// points that keyframes keep; what no kept point tells goes with the nearest view. The planes are tested first, in O(views log views);
// O(points of the views' keyframes + cells * views) only if that says so.
[[nodiscard]] std::optional<TrackedSurface> SplitOff(const std::vector<Keyframe>& keyframes, const MapperOptions& options,
                                                     MapSurface* surface, SurfaceTrack* track);

}  // namespace plumb::runtime
