// Which edges of a map are steps along arcs. Private to wall_mass.cc.
#pragma once

#include <vector>

#include "compiler/frontends/drawing/wall_mass.h"

namespace plumb::compiler {

// An arc, and the path that draws it.
struct SourcedArc {
  Arc arc;
  uint32_t source = 0;
};

[[nodiscard]] std::vector<SourcedArc> ArcsOf(const Drawing& drawing, const std::vector<uint32_t>& paths);
[[nodiscard]] Eigen::AlignedBox2d BoxAround(const Arc& arc);  // and a little more
[[nodiscard]] bool IsStepAlong(const Arc& arc, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

// Fills is_curved, circle_of and circles of `mass`. A path that is a curve without arcs, as a spline, is one all along.
void FindCurves(const Drawing& drawing, const std::vector<SourcedArc>& arcs, WallMass& mass);

}  // namespace plumb::compiler
