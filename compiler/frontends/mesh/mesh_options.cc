#include "compiler/frontends/mesh/mesh_options.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "compiler/frontends/mesh/mesh_frame.h"

namespace plumb::compiler {

std::string MeshOptions::Check() const {
  if (!unit.empty() && !UnitFromName(unit)) return fmt::format("MeshOptions.unit = `{}`; must be m, cm, mm, in or ft", unit);
  if (!up.empty() && up != "x" && up != "y" && up != "z") return fmt::format("MeshOptions.up = `{}`; must be x, y or z", up);
  const std::array<std::pair<const char*, double>, 9> positive = {{{"section_height_m", section_height_m},
                                                                   {"min_wall_thickness_m", min_wall_thickness_m},
                                                                   {"max_wall_thickness_m", max_wall_thickness_m},
                                                                   {"sheet_thickness_m", sheet_thickness_m},
                                                                   {"max_free_gap_m", max_free_gap_m},
                                                                   {"max_door_gap_m", max_door_gap_m},
                                                                   {"min_parapet_height_m", min_parapet_height_m},
                                                                   {"line_tolerance_m", line_tolerance_m},
                                                                   {"reader_time_s", reader_time_s}}};
  for (const auto& [name, value] : positive) {
    if (!(value > 0)) return fmt::format("MeshOptions.{} = {}; must be positive", name, value);
  }
  if (min_wall_thickness_m >= max_wall_thickness_m)
    return fmt::format("MeshOptions.min_wall_thickness_m = {}; must be less than max_wall_thickness_m", min_wall_thickness_m);
  if (max_triangles == 0) return "MeshOptions.max_triangles = 0; must be positive";
  return {};
}

}  // namespace plumb::compiler
