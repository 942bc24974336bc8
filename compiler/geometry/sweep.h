// Solids from plane profiles: extrusion, revolution, a disk along a path. Metres and radians.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compiler/geometry/solid.h"
#include "compiler/geometry/triangulate.h"

namespace plumb::compiler {

// A plane area: the inside of an odd number of the rings. Orientation of the rings does not matter.
using Area = std::vector<Ring2>;

// The profile in the xy plane, moved along `offset` (offset.z != 0). Closed, normals outward; empty for a degenerate profile.
[[nodiscard]] Solid Extrude(const Area& profile, const Eigen::Vector3d& offset);

// As Extrude, but ends in `end` at `offset`; point i of a ring of one goes to point i of the other. Empty if the rings do not pair.
[[nodiscard]] Solid Loft(const Area& start, const Area& end, const Eigen::Vector3d& offset);

// The profile, which must not cross the axis, turned about the axis through `axis_point` along `axis_direction` (both in the xy plane).
// `segments` flat steps over the angle; a full turn is closed without caps.
[[nodiscard]] Solid Revolve(const Area& profile, const Eigen::Vector2d& axis_point, const Eigen::Vector2d& axis_direction, double angle_rad,
                            int segments);

// A disk of `radius_m` with `sides` corners along the path, mitred at its bends; a path that ends where it began is closed.
[[nodiscard]] Solid SweepDisk(const std::vector<Eigen::Vector3d>& path, double radius_m, int sides);

// Flat steps for an arc so that chords stay within `chord_tolerance_m` of it: at least `min_per_turn` and at most 256 in a full turn.
[[nodiscard]] int ArcSegments(double radius_m, double sweep_rad, double chord_tolerance_m, int min_per_turn = 12);

}  // namespace plumb::compiler
