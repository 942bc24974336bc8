// How badly a plane fits its points, piece by piece along it.
#pragma once

#include <vector>

#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// Of lines fitted to strips of kStrip_m against the plane, bent to a parabola along the axis: the facet of a round column bends, so does a
// wall that bows. A plane laid over what is none, as over the narrow reveals between a wall and its windows, has each strip at its own
// offset and slope.
struct LackOfFit {
  double rms_m = 0;  // of the strips about the parabola, by points
  double ratio = 0;  // its variance per degree of freedom over the points' variance within the strips: about 1 for a plane with noise
};

inline constexpr double kStrip_m = 0.1;

// `cells`: sums over points close together; `axis`: a unit vector along the plane. Zero where there are too few strips with enough points.
// O(cells).
[[nodiscard]] LackOfFit LackOfFitOf(const std::vector<PlaneStats>& cells, const Plane& plane, const Eigen::Vector3d& axis);

}  // namespace plumb::runtime
