// The S-Graph as text for other programs: keyframes and surfaces of the building as built.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "runtime/mapping/sgraph.h"
#include "runtime/rooms/rooms.h"

namespace plumb::runtime {

// {"version": 1, "frame": "map" or "plan", "keyframes": [{id, t, position, orientation}], "surfaces": [{id, kind, normal, d_m, segment,
// z_min_m, z_max_m, area_m2, points, keyframes}], "floors": [{id, sensor_z_m, floor_z_m, ceiling_z_m, keyframes}], "rooms": [{id, floor,
// polygon, holes, area_m2, center, surfaces, doorways, covered_ratio, closed, visited}], "doorways": [{id, floor, position, yaw_rad,
// width_m, rooms}], "corridors": [{id, room, surfaces, centre_line, width_m}]}. Lengths in metres, orientations as quaternions x, y, z, w;
// a surface is the plane n . x + d = 0 with n into the free space, walls with their `segment` on the floor plan (free space on the left of
// the way from its start to its end). Upper layers as in rooms.h; what was not seen and rooms that are none are null. `T_plan_map`, where
// the map lies in a plan: everything is then in the plan's frame. Ends in a line break.
[[nodiscard]] std::string SGraphToJson(const SGraph& graph, const UpperLayers& layers, const std::optional<Eigen::Isometry3d>& T_plan_map);

}  // namespace plumb::runtime
