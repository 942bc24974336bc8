#include <cmath>
#include <nlohmann/json.hpp>

#include "runtime/deviations/deviations.h"
#include "runtime/deviations/deviations_keys.h"

namespace plumb::runtime {
namespace {

Json TextOrNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json SurfaceEntry(const AGraph& plan, const SurfaceDeviation& d) {
  const Surface& s = plan.surfaces[d.surface.index()];
  Json out;
  out["id"] = d.surface.value;
  out["wall_id"] = s.wall.valid() ? Json(s.wall.value) : Json(nullptr);
  out["wall_guid"] = s.wall.valid() ? TextOrNull(plan.walls[s.wall.index()].guid) : Json(nullptr);
  out["storey"] = s.storey.valid() ? Json(plan.storeys[s.storey.index()].name) : Json(nullptr);
  out["normal"] = {Rounded(s.normal.x(), 1e9), Rounded(s.normal.y(), 1e9), Rounded(s.normal.z(), 1e9)};
  PutEstimate(d, out);
  out["unjudged"] = TextOrNull(UnjudgedName(d.unjudged));
  out["tilt_deg"] = Degrees(d.tilt_rad);
  out["mdb_m"] = std::isfinite(d.mdb_m) ? Json(Metres(d.mdb_m)) : Json(nullptr);
  out["observed_m2"] = Rounded(d.observed_m2, 1e2);
  out["points"] = static_cast<int64_t>(std::llround(d.points));
  return out;
}

Json RoomEntry(const AGraph& plan, const RoomDeviation& d) {
  const Room& room = plan.rooms[d.room.index()];
  Json out;
  out["id"] = d.room.value;
  out["name"] = room.name;
  out["guid"] = TextOrNull(room.guid);
  out["translation_m"] = {Metres(d.translation_m.x()), Metres(d.translation_m.y())};
  out["rotation_deg"] = Degrees(d.rotation_rad);
  out["sigma_m"] = Metres(d.sigma_m);
  out["status"] = StatusName(d.status);
  return out;
}

Json DoorwayEntry(const AGraph& plan, const DoorwayDeviation& d) {
  const Doorway& doorway = plan.doorways[d.doorway.index()];
  Json out;
  out["id"] = d.doorway.value;
  out["guid"] = TextOrNull(doorway.guid);
  out["wall_guid"] = doorway.wall.valid() ? TextOrNull(plan.walls[doorway.wall.index()].guid) : Json(nullptr);
  out["storey"] = doorway.storey.valid() ? Json(plan.storeys[doorway.storey.index()].name) : Json(nullptr);
  out["width_m"] = Metres(doorway.width_m);
  PutEstimate(d, out);
  return out;
}

Json UnplannedEntry(const UnplannedWall& w) {
  Json out;
  out["polygon"] = Json::array();
  for (const Eigen::Vector2d& p : w.polygon) out["polygon"].push_back({Metres(p.x()), Metres(p.y())});
  out["height_m"] = Metres(w.height_m);
  out["room"] = w.room.value;
  return out;
}

}  // namespace

std::string DeviationsToJson(const AGraph& plan, const DeviationReport& report) {
  Json out;
  out["version"] = 1;
  out["gauge"] = report.gauge;
  out["surfaces"] = Json::array();
  for (const SurfaceDeviation& d : report.surfaces) out["surfaces"].push_back(SurfaceEntry(plan, d));
  out["rooms"] = Json::array();
  for (const RoomDeviation& d : report.rooms) out["rooms"].push_back(RoomEntry(plan, d));
  out["unplanned"] = Json::array();
  for (const UnplannedWall& w : report.unplanned) out["unplanned"].push_back(UnplannedEntry(w));
  out["doorways"] = Json::array();
  for (const DoorwayDeviation& d : report.doorways) out["doorways"].push_back(DoorwayEntry(plan, d));
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace plumb::runtime
