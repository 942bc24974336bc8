// The building as it was seen, as points.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "runtime/localizer/localizer.h"

namespace plumb::tools {

// The keyframes' points, the first of each voxel: in the plan frame, or the map's own where nobody knows where in the plan it lies.
[[nodiscard]] std::vector<Eigen::Vector3d> AsBuiltCloud(const runtime::Localizer& localizer, double voxel_m);

}  // namespace plumb::tools
