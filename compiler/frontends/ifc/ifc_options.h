// Options of the IFC frontend.
#pragma once

#include <cstddef>
#include <string>

namespace plumb::compiler {

struct IfcOptions {
  double chord_tolerance_m = 0.002;  // flat steps keep this close to the arcs they stand for
  double weld_tolerance_m = 1e-6;    // points of a brep closer than this are one
  double plane_epsilon_m = 1e-6;     // faces of a wall and of its openings closer than this coincide (CsgOptions)
  double glass_transparency = 0.3;   // surface styles more transparent than this are glass, 0..1
  double pane_max_thickness_m =
      0.06;                        // a window's part that no style tells apart is a pane if it is flat, upright and thinner than this ...
  double pane_min_area_m2 = 0.04;  // ... and larger than this
  double far_origin_m = 1000;      // plans farther from zero than this are moved near it (PlanIr::origin)
  double fill_min_overlap = 0.5;   // a door without IfcRelFillsElement fills the opening that holds this much of its box, 0..1
  size_t max_triangles_per_element = 2000000;  // more is cut off with a diagnostic: mapped items can multiply without bound
  size_t max_cut_triangles = 25000000;         // of bodies that openings are cut out of, counted for each cut; a plan with more is refused
  size_t max_triangles = 6000000;              // of all elements; a plan with more is refused: it would not fit into 2 GB
  // Empty if every field is valid; else names the field, its value and the rule.
  [[nodiscard]] std::string Check() const;
};

}  // namespace plumb::compiler
