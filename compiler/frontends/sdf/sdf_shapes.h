// Solids of the shapes that SDF describes by numbers, in the frame of their geometry element.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compiler/geometry/solid.h"

namespace plumb::compiler {

[[nodiscard]] Solid MakeCylinder(double radius_m, double length_m);
[[nodiscard]] Solid MakeSphere(double radius_m);
[[nodiscard]] Solid MakePlane(const Eigen::Vector3d& normal, const Eigen::Vector2d& size_m);

}  // namespace plumb::compiler
