// Planar segments of a keyframe.
#pragma once

#include <vector>

#include "runtime/mapping/keyframe_window.h"
#include "runtime/mapping/mapper_options.h"
#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// Walls within 15 degrees of vertical, floors and ceilings within 15 degrees of level; other planes are left out. Surfels grow into regions,
// those with most points first; then every point in the band about a region's plane, seen from its free side, goes to the nearest region,
// and the planes are fitted to these (total least squares). A point counts once. In order of the regions' sizes. O(points).
[[nodiscard]] std::vector<Segment> ExtractSegments(const KeyframeWindow& window, const MapperOptions& options);

// Two directions along a plane, in the order (along, across). Walls: along is horizontal and has the free space on its left, across is upwards;
// floors and ceilings: along is close to the frame's x axis. `up` is away from gravity.
struct PlaneAxes {
  Eigen::Vector3d along, across;
};
[[nodiscard]] PlaneAxes AxesOf(const Plane& plane, SurfaceKind kind, const Eigen::Vector3d& up);

inline constexpr double kCell_m = 0.1;  // of occupancy on surfaces

}  // namespace plumb::runtime
