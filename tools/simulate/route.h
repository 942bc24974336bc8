// Ways through the free space: shortest on the grid with some room to spare, then straightened.
#pragma once

#include <vector>

#include "tools/simulate/free_space.h"

namespace plumb::tools {

using Polyline = std::vector<Eigen::Vector2d>;

// From one cell to another with clearance of at least `radius_m`; few straight pieces. Empty if there is no way. O(area log area).
[[nodiscard]] Polyline FindRoute(const FreeSpace& space, size_t from, size_t to, double radius_m);

// The smallest clearance along the straight line between two points.
[[nodiscard]] double ClearanceAlong(const FreeSpace& space, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

}  // namespace plumb::tools
