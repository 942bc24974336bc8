// Pass on FloorIr: which walls are curved. Sources draw curves as exact arcs, as facets (meshes, boundary representations) or as splines;
// after this pass all of them are arcs.
#pragma once

#include "compiler/ir/floor_ir.h"

namespace plumb::compiler {

struct WallArcOptions {
  double radial_m = 0.002;      // corners of an arc lie this close to its circle
  double sagitta_m = 0.01;      // a facet may stand off its arc by no more: beyond that it is a flat wall of its own
  double max_turn_rad = 0.53;   // from facet to facet (30 deg)
  double min_turn_rad = 0.004;  // straighter corners are none
  double min_sweep_rad = 0.26;  // of a whole arc (15 deg)
  size_t min_facets = 4;
  [[nodiscard]] std::string Check() const;
};

// Fills PlanWall::arcs: the source's arcs, then those of circles through corners of the wall's outline in the planar map where at least
// `min_facets` sides follow one. Arcs run as the outline does, the wall on the left. Linear in edges, but for long arcs O(n^2) in their
// facets.
void FindWallArcs(const PlanIr& plan, const WallArcOptions& options, FloorIr& floors);

}  // namespace plumb::compiler
