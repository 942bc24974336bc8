// Which edges of a map are steps along arcs. Private to wall_mass.cc.
#pragma once

#include <vector>

#include "compiler/frontends/drawing/wall_mass.h"

namespace plumb::compiler {

// Fills is_curved, circle_of and circles of `mass` by the arcs of `paths`. A curve without arcs, as a spline, is one all along.
void FindCurves(const Drawing& drawing, const std::vector<uint32_t>& paths, WallMass& mass);

}  // namespace plumb::compiler
