// The S-Graph as text for other programs: keyframes and surfaces of the building as built.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// {"version": 1, "frame": "map" or "plan", "keyframes": [{id, t, position, orientation}], "surfaces": [{id, kind, normal, d_m, segment,
// z_min_m, z_max_m, area_m2, points, keyframes}]}. Lengths in metres, orientations as quaternions x, y, z, w; a surface is the plane
// n . x + d = 0 with n into the free space, walls with their `segment` on the floor plan (free space on the left of the way from its start
// to its end). `T_plan_map`, where the map lies in a plan: everything is then in the plan's frame. Ends in a line break.
[[nodiscard]] std::string SGraphToJson(const SGraph& graph, const std::optional<Eigen::Isometry3d>& T_plan_map);

}  // namespace plumb::runtime
