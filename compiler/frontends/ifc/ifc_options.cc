#include "compiler/frontends/ifc/ifc_options.h"

#include <fmt/format.h>

#include <limits>

namespace plumb::compiler {

std::string IfcOptions::Check() const {
  const auto between = [](const char* name, double value, double low, double high) {
    return value > low && value <= high ? std::string()
                                        : fmt::format("IfcOptions.{} = {}; must be above {} and at most {}", name, value, low, high);
  };
  for (const std::string& problem :
       {between("chord_tolerance_m", chord_tolerance_m, 0, 0.1), between("weld_tolerance_m", weld_tolerance_m, 0, 1e-3),
        between("plane_epsilon_m", plane_epsilon_m, 0, 1e-3), between("glass_transparency", glass_transparency, 0, 1),
        between("pane_max_thickness_m", pane_max_thickness_m, 0, 1), between("pane_min_area_m2", pane_min_area_m2, 0, 100),
        between("far_origin_m", far_origin_m, 0, std::numeric_limits<double>::max()),
        between("fill_min_overlap", fill_min_overlap, 0, 1)}) {
    if (!problem.empty()) return problem;
  }
  if (max_triangles == 0) return "IfcOptions.max_triangles = 0; must be positive";
  if (max_cut_triangles == 0) return "IfcOptions.max_cut_triangles = 0; must be positive";
  if (max_triangles_per_element == 0) return "IfcOptions.max_triangles_per_element = 0; must be positive";
  return {};
}

}  // namespace plumb::compiler
