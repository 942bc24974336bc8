#include "runtime/mapping/sgraph_json.h"

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

}  // namespace

std::string SGraphToJson(const SGraph& graph, const std::optional<Eigen::Isometry3d>& T_plan_map) {
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
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace plumb::runtime
