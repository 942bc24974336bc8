// Pass PlanIr -> FloorIr, second half: the footprints of a level as a clean planar map (exact arrangement of their outlines).
#pragma once

#include <string>

#include "compiler/ir/floor_ir.h"
#include "schema/error.h"

namespace plumb::compiler {

struct PlanarMapOptions {
  double snap_radius_m = 0.002;    // vertices and edges closer than this meet: walls drawn with small gaps close their rooms
  double max_strip_width_m = 0.5;  // parts of a divided open plan narrower than this that no space claims go to a neighbour
  [[nodiscard]] std::string Check() const;
};

// Fills vertices and faces of `floor` from its footprints that bound rooms and its dividers. Faces are labelled with the footprints over
// them by carrying winding numbers across edges from the unbounded face, so a label never depends on a rounded test point. Vertices are in
// lexicographic order, faces in the order of their outer boundaries: the order of the footprints does not matter. Dividers cover nothing:
// they only divide the free region that holds most of each. Errors: kInternal.
[[nodiscard]] Expected<void> BuildPlanarMap(Floor& floor, const PlanarMapOptions& options);

}  // namespace plumb::compiler
