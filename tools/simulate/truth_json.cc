#include "tools/simulate/truth_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace plumb::tools {
namespace {

using Json = nlohmann::ordered_json;

// Deviations to a micrometre and a millionth of a degree: more digits would only be noise of the arithmetic.
double Rounded(double value) { return std::round(value * 1e6) / 1e6; }
double Degrees(double rad) { return Rounded(rad * 180 / std::numbers::pi); }

Json ToJson(const AGraph& plan, const WallDisplacement& w) {
  const Wall& wall = plan.walls[w.wall.index()];
  Json json = {{"wall_guid", wall.guid},
               {"wall_id", w.wall.value},
               {"wall_name", wall.name},
               {"reference_surface", w.reference.value},
               {"translation_m", Rounded(w.translation_m)},
               {"rotation_deg", Degrees(w.rotation_rad)},
               {"surfaces", Json::array()}};
  for (const SurfaceDisplacement& s : w.surfaces) {
    const double translation_m = Rounded(s.translation_m), rotation_deg = Degrees(s.rotation_rad);
    json["surfaces"].push_back({{"id", s.surface.value}, {"translation_m", translation_m}, {"rotation_deg", rotation_deg}});
  }
  return json;
}

Json ToJson(const AGraph& plan, const MissingWall& m) {
  const Wall& wall = plan.walls[m.wall.index()];
  return {{"wall_guid", wall.guid}, {"wall_id", m.wall.value}, {"wall_name", wall.name}, {"rays_through", m.rays_through}};
}

Json ToJson(const UnplannedWall& w) {
  Json polygon = Json::array();
  for (const Eigen::Vector2d& p : w.polygon) polygon.push_back({Rounded(p.x()), Rounded(p.y())});
  return {{"polygon", polygon}, {"height_m", Rounded(w.height_m)}, {"points", w.points}};
}

Json ToJson(const AGraph& plan, const BuiltDoorway& d) {
  const Doorway& doorway = plan.doorways[d.doorway.index()];
  return {{"id", d.doorway.value},
          {"guid", doorway.guid},
          {"name", doorway.name},
          {"shift_m", Rounded(d.shift_m)},
          {"width_deviation_m", Rounded(d.width_deviation_m)},
          {"rays_through", d.rays_through}};
}

Json ToJson(const SimulateOptions& o) {
  return {{"seed", o.seed},
          {"deviate", o.deviate},
          {"deviate_ratio", o.deviate_ratio},
          {"missing", o.missing},
          {"unplanned", o.unplanned},
          {"doorways", o.doorways},
          {"doorways_ratio", o.doorways_ratio},
          {"doorway_m", {o.min_doorway_m, o.max_doorway_m}},
          {"translation_m", {o.min_translation_m, o.max_translation_m}},
          {"rotation_deg", {Degrees(o.min_rotation_rad), Degrees(o.max_rotation_rad)}},
          {"sensor", o.sensor},
          {"noise_m", o.noise_m},
          {"storey", o.storey},
          {"speed_m_s", o.speed_m_s},
          {"sensor_height_m", o.sensor_height_m},
          {"min_duration_s", o.min_duration_s},
          {"max_duration_s", o.max_duration_s},
          {"wobble_rad", o.wobble_rad},
          {"glass_transmission", o.glass_transmission},
          {"clutter", o.clutter},
          {"start_stamp_s", o.start_stamp_s},
          {"odometry_rate_hz", o.odometry_rate_hz},
          {"odometry_scale_sigma", o.odometry_scale_sigma},
          {"odometry_yaw_bias_sigma_rad_s", o.odometry_yaw_bias_sigma_rad_s},
          {"odometry_yaw_walk_rad_sqrt_s", o.odometry_yaw_walk_rad_sqrt_s},
          {"odometry_slip", o.odometry_slip}};
}

Json Rooms(const AGraph& plan, const std::vector<RoomId>& rooms) {
  Json json = Json::array();
  for (const RoomId id : rooms) json.push_back({{"id", id.value}, {"name", plan.rooms[id.index()].name}});
  return json;
}

}  // namespace

std::string TruthToJson(const AGraph& plan, const SimulateOptions& options, const SimulateSummary& summary) {
  Json json = {{"version", 1},
               {"plan", {{"source", plan.source_path}, {"sha256", plan.source_sha256}}},
               {"seed", options.seed},
               {"storey", summary.storey.value},
               {"walls", Json::array()},
               {"missing", Json::array()},
               {"unplanned", Json::array()},
               {"doorways", Json::array()},
               {"surface_points", Json::object()},
               {"surface_seen_m2", Json::object()}};
  for (const WallDisplacement& w : summary.walls) json["walls"].push_back(ToJson(plan, w));
  for (const MissingWall& m : summary.missing) json["missing"].push_back(ToJson(plan, m));
  for (const UnplannedWall& w : summary.unplanned) json["unplanned"].push_back(ToJson(w));
  for (const BuiltDoorway& d : summary.doorways) json["doorways"].push_back(ToJson(plan, d));
  for (size_t i = 0; i < summary.surface_points.size(); ++i) json["surface_points"][std::to_string(i)] = summary.surface_points[i];
  for (size_t i = 0; i < summary.surface_seen_m2.size(); ++i) {
    json["surface_seen_m2"][std::to_string(i)] = Rounded(summary.surface_seen_m2[i]);
  }
  json["drive"] = {{"duration_s", Rounded(summary.duration_s)},
                   {"path_m", Rounded(summary.path_m)},
                   {"robot_radius_m", summary.robot_radius_m},
                   {"start_room", summary.start_room.value},
                   {"visited", Rooms(plan, summary.visited)},
                   {"not_visited", Rooms(plan, summary.not_visited)},
                   {"boxes", summary.boxes}};
  json["options"] = ToJson(options);
  return json.dump(1) + "\n";
}

}  // namespace plumb::tools
