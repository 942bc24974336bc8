// Horizontal sections of triangulated solids.
#pragma once

#include <vector>

#include "compiler/ir/plan_ir.h"

namespace plumb::compiler {

struct Section {
  std::vector<Ring> rings;  // outer ones counter-clockwise, holes clockwise
  bool closed = true;       // false: the surface has gaps there; `rings` is then the least rectangle around what was found
};

// What `solid` has at height z_m. A vertex at that very height counts as above. Collinear points are removed.
[[nodiscard]] Section CutSolid(const Solid& solid, double z_m);

}  // namespace plumb::compiler
