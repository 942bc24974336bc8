// Lines of straight sides in space.
#pragma once

#include <Eigen/Core>

#include "compiler/geometry/triangulate.h"

namespace plumb::compiler {

// The part of `line`, which has two points or more, between two places on it, `start` and `end` themselves its ends. A line that ends where
// it began is followed along or, if `forward` is false, against its direction, and whole where both places are one; an open one the way
// that leads from one to the other. O(points).
[[nodiscard]] Ring3 PartOfPolyline(Ring3 line, const Eigen::Vector3d& start, const Eigen::Vector3d& end, bool forward);

}  // namespace plumb::compiler
