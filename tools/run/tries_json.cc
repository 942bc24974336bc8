#include "tools/run/tries_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace plumb::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegPerRad = 180 / std::numbers::pi;

// Digits beyond these are noise.
double Rounded(double value, double unit) { return std::round(value / unit) * unit; }

Json RoomToJson(const std::optional<RoomId>& room) { return room ? Json(room->index()) : Json(nullptr); }

Json HypothesisToJson(const HypothesisRow& h) {
  Json out;
  out["probability"] = Rounded(h.probability, 1e-6);
  out["log_likelihood"] = Rounded(h.log_likelihood, 1e-2);
  out["position"] = {Rounded(h.position_m.x(), 1e-3), Rounded(h.position_m.y(), 1e-3), Rounded(h.position_m.z(), 1e-3)};
  out["yaw_deg"] = Rounded(h.yaw_rad * kDegPerRad, 1e-2);
  out["sigma_xy_m"] = Rounded(h.sigma_xy_m, 1e-3);
  out["sigma_yaw_deg"] = Rounded(h.sigma_yaw_rad * kDegPerRad, 1e-2);
  out["storey"] = h.storey;
  out["room"] = RoomToJson(h.room);
  out["room_name"] = h.room_name;
  out["consistent_planes"] = h.consistent_planes;
  out["consistent_ratio"] = Rounded(h.consistent_ratio, 1e-3);
  out["explained_ratio"] = Rounded(h.explained_ratio, 1e-3);
  out["through_ratio"] = Rounded(h.through_ratio, 1e-3);
  return out;
}

Json DriveToToJson(const DriveToRow& d) {
  Json out;
  out["rooms"] = Json::array();
  for (const std::optional<RoomId>& room : d.rooms) out["rooms"].push_back(RoomToJson(room));
  out["room_names"] = d.room_names;
  out["position"] = {Rounded(d.position_m.x(), 1e-3), Rounded(d.position_m.y(), 1e-3), Rounded(d.position_m.z(), 1e-3)};
  out["bearing_deg"] = Rounded(d.bearing_rad * kDegPerRad, 1e-1);
  out["distance_m"] = Rounded(d.distance_m, 1e-2);
  out["expected_nats"] = Rounded(d.expected_nats, 1e-2);
  out["rivals_split"] = d.rivals_split;
  return out;
}

}  // namespace

std::string TriesToJson(const std::vector<TryRow>& tries) {
  Json rows = Json::array();
  for (const TryRow& t : tries) {
    Json row;
    row["t"] = t.stamp_s;
    row["verdict"] = t.verdict;
    row["reason"] = t.reason;
    row["probability_outside"] = Rounded(t.probability_outside, 1e-6);
    row["hypotheses"] = Json::array();
    for (const HypothesisRow& h : t.hypotheses) row["hypotheses"].push_back(HypothesisToJson(h));
    if (t.guidance) {
      row["rivals"] = t.guidance->rivals;
      row["drive_to"] = t.guidance->drive_to ? DriveToToJson(*t.guidance->drive_to) : Json(nullptr);
    }
    rows.push_back(std::move(row));
  }
  Json out;
  out["version"] = 1;
  out["tries"] = std::move(rows);
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace plumb::tools
