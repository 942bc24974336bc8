#include "runtime/rooms/sgraph_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "runtime/numerics/rounded.h"

namespace plumb::runtime {
namespace {

using Json = nlohmann::ordered_json;

double Metres(double v) { return Rounded(v, 1e5); }
double Unit(double v) { return Rounded(v, 1e9); }

const char* KindName(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::kWall: return "wall";
    case SurfaceKind::kFloor: return "floor";
    case SurfaceKind::kCeiling: return "ceiling";
  }
  return "wall";
}

Json KeyframeEntry(const Keyframe& keyframe, const Eigen::Isometry3d& T_out_map) {
  const Eigen::Isometry3d T = T_out_map * keyframe.T_map_kf;
  Eigen::Quaterniond q(T.linear());
  if (q.w() < 0) q.coeffs() *= -1;
  Json out;
  out["id"] = keyframe.id;
  out["t"] = Rounded(keyframe.stamp_s, 1e9);
  out["position"] = {Metres(T.translation().x()), Metres(T.translation().y()), Metres(T.translation().z())};
  out["orientation"] = {Unit(q.x()), Unit(q.y()), Unit(q.z()), Unit(q.w())};
  return out;
}

Json SurfaceEntry(const MapSurface& surface, const Eigen::Isometry3d& T_out_map) {
  const Plane plane = surface.plane.Transformed(T_out_map);
  const Eigen::Vector3d start = T_out_map * Eigen::Vector3d(surface.start.x(), surface.start.y(), surface.z_min_m);
  const Eigen::Vector3d end = T_out_map * Eigen::Vector3d(surface.end.x(), surface.end.y(), surface.z_max_m);
  std::set<uint32_t> keyframes;
  for (const Observation& o : surface.observations) keyframes.insert(o.keyframe);
  Json out;
  out["id"] = surface.id;
  out["kind"] = KindName(surface.kind);
  out["normal"] = {Unit(plane.n.x()), Unit(plane.n.y()), Unit(plane.n.z())};
  out["d_m"] = Metres(plane.d);
  if (surface.kind == SurfaceKind::kWall) out["segment"] = {{Metres(start.x()), Metres(start.y())}, {Metres(end.x()), Metres(end.y())}};
  out["z_min_m"] = Metres(start.z());
  out["z_max_m"] = Metres(end.z());
  out["area_m2"] = Rounded(surface.area_m2, 1e2);
  out["points"] = static_cast<int64_t>(std::llround(surface.num_points));
  out["keyframes"] = keyframes;
  return out;
}

Json At(const Eigen::Vector2d& p, const Eigen::Isometry3d& T_out_map) {
  const Eigen::Vector3d q = T_out_map * Eigen::Vector3d(p.x(), p.y(), 0);
  return {Metres(q.x()), Metres(q.y())};
}

Json PolygonEntry(const Polygon2& polygon, const Eigen::Isometry3d& T_out_map) {
  Json out = Json::array();
  for (const Eigen::Vector2d& p : polygon) out.push_back(At(p, T_out_map));
  return out;
}

Json HeightEntry(const std::optional<double>& z_m, const Eigen::Isometry3d& T_out_map) {
  return z_m ? Json(Metres(*z_m + T_out_map.translation().z())) : Json();
}

Json FloorEntry(const MapFloor& floor, const Eigen::Isometry3d& T_out_map) {
  Json out;
  out["id"] = floor.id;
  out["sensor_z_m"] = HeightEntry(floor.sensor_z_m, T_out_map);
  out["floor_z_m"] = HeightEntry(floor.floor_z_m, T_out_map);
  out["ceiling_z_m"] = HeightEntry(floor.ceiling_z_m, T_out_map);
  out["keyframes"] = floor.keyframes;
  return out;
}

Json RoomEntry(const MapRoom& room, const Eigen::Isometry3d& T_out_map) {
  Json out;
  out["id"] = room.id;
  out["floor"] = room.floor;
  out["polygon"] = PolygonEntry(room.polygon, T_out_map);
  out["holes"] = Json::array();
  for (const Polygon2& hole : room.holes) out["holes"].push_back(PolygonEntry(hole, T_out_map));
  out["area_m2"] = Rounded(room.area_m2, 1e2);
  out["center"] = At(room.center, T_out_map);
  out["surfaces"] = room.surfaces;
  out["doorways"] = room.doorways;
  out["covered_ratio"] = Rounded(room.covered_ratio, 1e3);
  out["closed"] = room.closed;
  out["visited"] = room.visited;
  return out;
}

Json DoorwayEntry(const MapDoorway& doorway, const Eigen::Isometry3d& T_out_map) {
  const Eigen::Vector3d along = T_out_map.linear() * Eigen::Vector3d(std::cos(doorway.yaw_rad), std::sin(doorway.yaw_rad), 0);
  Json out;
  out["id"] = doorway.id;
  out["floor"] = doorway.floor;
  out["position"] = At(doorway.position, T_out_map);
  out["yaw_rad"] = Rounded(std::atan2(along.y(), along.x()), 1e5);
  out["width_m"] = Rounded(doorway.width_m, 1e3);
  out["rooms"] = {Json(doorway.room_a), doorway.room_b ? Json(*doorway.room_b) : Json()};
  return out;
}

Json CorridorEntry(const MapCorridor& corridor, const Eigen::Isometry3d& T_out_map) {
  Json out;
  out["id"] = corridor.id;
  out["room"] = corridor.room;
  out["surfaces"] = {corridor.surface_a, corridor.surface_b};
  out["centre_line"] = {At(corridor.start, T_out_map), At(corridor.end, T_out_map)};
  out["width_m"] = Rounded(corridor.width_m, 1e3);
  return out;
}

}  // namespace

std::string SGraphToJson(const SGraph& graph, const UpperLayers& layers, const std::optional<Eigen::Isometry3d>& T_plan_map) {
  const Eigen::Isometry3d T_out_map = T_plan_map.value_or(Eigen::Isometry3d::Identity());
  Json out;
  out["version"] = 1;
  out["frame"] = T_plan_map ? "plan" : "map";
  out["keyframes"] = Json::array();
  for (const Keyframe& keyframe : graph.keyframes) {
    if (!keyframe.merged) out["keyframes"].push_back(KeyframeEntry(keyframe, T_out_map));
  }
  out["surfaces"] = Json::array();
  for (const MapSurface& surface : graph.surfaces) {
    if (!surface.observations.empty()) out["surfaces"].push_back(SurfaceEntry(surface, T_out_map));
  }
  const auto add = [&](const char* key, const auto& things, const auto& entry) {
    out[key] = Json::array();
    for (const auto& thing : things) out[key].push_back(entry(thing, T_out_map));
  };
  add("floors", layers.floors, FloorEntry);
  add("rooms", layers.rooms, RoomEntry);
  add("doorways", layers.doorways, DoorwayEntry);
  add("corridors", layers.corridors, CorridorEntry);
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace plumb::runtime
