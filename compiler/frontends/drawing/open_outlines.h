// Walls that were drawn but not found, as their outlines do not close. Private to wall_report.cc.
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/frontends/drawing/wall_mass.h"

namespace plumb::compiler {

struct OpenOutline {
  double length_m = 0;  // of the lines that face each other as the two sides of a wall do
  std::vector<uint32_t> edges;  // those lines, in the map
  uint32_t path = 0;    // of the longest of them, in the drawing
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  // where it ends openly, else its middle
};

// Lines on layers of walls that lie beside each other as the sides of walls do and bound none, by what hangs together; the longest first.
[[nodiscard]] std::vector<OpenOutline> FindOpenOutlines(const Drawing& drawing, const WallMass& mass, const MassOptions& options);

}  // namespace plumb::compiler
