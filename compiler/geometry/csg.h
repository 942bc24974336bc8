// Boolean difference of closed triangle solids, by binary space partitions (Naylor, Amanatides, Thibault 1990) over convex polygons.
//
// Guarantees: (1) points within `plane_epsilon_m` of a plane count as on it: faces of both operands that coincide to that precision leave
// neither a skin nor a hole; (2) triangles of `a` that `b` does not cut into are passed on, but for corners of their neighbours that come
// to lie on their edges; (3) the result of closed operands is closed edge by edge (IsClosed), as far as no feature is as thin as the
// planes. Operands are moved near zero inside; far coordinates cost no precision beyond their own. O((n + m) log(n + m)) for usual solids.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "compiler/geometry/solid.h"
#include "schema/error.h"

namespace plumb::compiler {

struct CsgOptions {
  double plane_epsilon_m = 1e-6;  // thickness of a plane
  size_t max_polygons = 400000;   // in any step; more is an error, not a long wait
  int max_depth = 3000;           // of the partition
  // Empty if every field is valid; else names the field, its value and the rule.
  [[nodiscard]] std::string Check() const;
};

// a minus b; normals outward in both. Errors: kBadOption, kInternal (a limit was reached).
[[nodiscard]] Expected<Solid> Subtract(const Solid& a, const Solid& b, const CsgOptions& options = {});

struct DifferenceOfMany {
  Solid rest;
  std::vector<bool> cuts;  // by tool: it took something away
};

// a minus all `tools` at once, which must lie apart from one another by more than the planes: one step whatever their number, where cutting
// one after the other would touch all that was cut before. Errors as for Subtract.
[[nodiscard]] Expected<DifferenceOfMany> SubtractAll(const Solid& a, std::span<const Solid* const> tools, const CsgOptions& options = {});

// The part of the surface `a`, which need not be closed, that is outside the closed solid `b`. Errors as for Subtract.
[[nodiscard]] Expected<Solid> ClipOutside(const Solid& a, const Solid& b, const CsgOptions& options = {});

// The part of `a` on the side of the plane n . x + d = 0 to which n does not point, closed along the plane. Errors as for Subtract.
[[nodiscard]] Expected<Solid> CutByPlane(const Solid& a, const Eigen::Vector3d& n, double d_m, const CsgOptions& options = {});

}  // namespace plumb::compiler
