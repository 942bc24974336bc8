#include "tools/run/tries_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "runtime/numerics/rounded.h"

namespace plumb::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegPerRad = 180 / std::numbers::pi;

using runtime::Rounded;  // further digits are noise

Json RoomToJson(const std::optional<RoomId>& room) { return room ? Json(room->index()) : Json(nullptr); }

Json HypothesisToJson(const HypothesisRow& h) {
  Json out;
  out["probability"] = Rounded(h.probability, 1e6);
  out["log_likelihood"] = Rounded(h.log_likelihood, 1e2);
  out["position"] = {Rounded(h.position_m.x(), 1e3), Rounded(h.position_m.y(), 1e3), Rounded(h.position_m.z(), 1e3)};
  out["yaw_deg"] = Rounded(h.yaw_rad * kDegPerRad, 1e2);
  out["sigma_xy_m"] = h.sigma_xy_m ? Json(Rounded(*h.sigma_xy_m, 1e3)) : Json(nullptr);
  out["sigma_yaw_deg"] = h.sigma_yaw_rad ? Json(Rounded(*h.sigma_yaw_rad * kDegPerRad, 1e2)) : Json(nullptr);
  out["storey"] = h.storey;
  out["room"] = RoomToJson(h.room);
  out["room_name"] = h.room_name;
  out["consistent_planes"] = h.consistent_planes;
  out["consistent_ratio"] = Rounded(h.consistent_ratio, 1e3);
  out["explained_ratio"] = Rounded(h.explained_ratio, 1e3);
  out["through_ratio"] = Rounded(h.through_ratio, 1e3);
  out["in_front_ratio"] = Rounded(h.in_front_ratio, 1e3);
  return out;
}

Json DriveToToJson(const DriveToRow& d) {
  Json out;
  out["rooms"] = Json::array();
  for (const std::optional<RoomId>& room : d.rooms) out["rooms"].push_back(RoomToJson(room));
  out["room_names"] = d.room_names;
  out["position"] = {Rounded(d.position_m.x(), 1e3), Rounded(d.position_m.y(), 1e3), Rounded(d.position_m.z(), 1e3)};
  out["bearing_deg"] = Rounded(d.bearing_rad * kDegPerRad, 1e1);
  out["distance_m"] = Rounded(d.distance_m, 1e2);
  out["expected_nats"] = Rounded(d.expected_nats, 1e2);
  out["rivals_split"] = d.rivals_split;
  return out;
}

std::optional<RoomId> ParseRoomId(const Json& json) { return json.is_null() ? std::nullopt : std::optional(RoomId(json.get<uint32_t>())); }

Eigen::Vector3d ParsePosition(const Json& json) { return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()}; }

HypothesisRow ParseHypothesis(const Json& json) {
  HypothesisRow h;
  json.at("probability").get_to(h.probability);
  json.at("log_likelihood").get_to(h.log_likelihood);
  h.position_m = ParsePosition(json.at("position"));
  h.yaw_rad = json.at("yaw_deg").get<double>() / kDegPerRad;
  if (const Json& sigma = json.at("sigma_xy_m"); !sigma.is_null()) h.sigma_xy_m = sigma.get<double>();
  if (const Json& sigma = json.at("sigma_yaw_deg"); !sigma.is_null()) h.sigma_yaw_rad = sigma.get<double>() / kDegPerRad;
  json.at("storey").get_to(h.storey);
  h.room = ParseRoomId(json.at("room"));
  json.at("room_name").get_to(h.room_name);
  json.at("consistent_planes").get_to(h.consistent_planes);
  json.at("consistent_ratio").get_to(h.consistent_ratio);
  json.at("explained_ratio").get_to(h.explained_ratio);
  json.at("through_ratio").get_to(h.through_ratio);
  h.in_front_ratio = json.value("in_front_ratio", 0.0);  // older files have none
  return h;
}

DriveToRow ParseDriveTo(const Json& json) {
  DriveToRow d;
  for (const Json& room : json.at("rooms")) d.rooms.push_back(ParseRoomId(room));
  json.at("room_names").get_to(d.room_names);
  d.position_m = ParsePosition(json.at("position"));
  d.bearing_rad = json.at("bearing_deg").get<double>() / kDegPerRad;
  json.at("distance_m").get_to(d.distance_m);
  json.at("expected_nats").get_to(d.expected_nats);
  json.at("rivals_split").get_to(d.rivals_split);
  return d;
}

TryRow ParseTry(const Json& json) {
  TryRow row;
  json.at("t").get_to(row.stamp_s);
  json.at("verdict").get_to(row.verdict);
  json.at("reason").get_to(row.reason);
  json.at("probability_outside").get_to(row.probability_outside);
  for (const Json& h : json.at("hypotheses")) row.hypotheses.push_back(ParseHypothesis(h));
  if (json.contains("rivals")) {
    row.guidance = GuidanceRow{json.at("rivals").get<int>(), std::nullopt};
    if (const Json& d = json.at("drive_to"); !d.is_null()) row.guidance->drive_to = ParseDriveTo(d);
  }
  return row;
}

}  // namespace

std::string TriesToJson(const std::vector<TryRow>& tries) {
  Json rows = Json::array();
  for (const TryRow& t : tries) {
    Json row;
    row["t"] = t.stamp_s;
    row["verdict"] = t.verdict;
    row["reason"] = t.reason;
    row["probability_outside"] = Rounded(t.probability_outside, 1e6);
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

Expected<std::vector<TryRow>> ParseTries(const std::string& json, const std::string& source) {
  try {
    const Json root = Json::parse(json);
    if (root.at("version") != 1) return Fail(ErrorCode::kBadRunFolder, fmt::format("`{}` has another version than 1", source));
    std::vector<TryRow> tries;
    for (const Json& row : root.at("tries")) tries.push_back(ParseTry(row));
    return tries;
  } catch (const Json::exception& e) {
    return Fail(ErrorCode::kBadRunFolder, fmt::format("`{}`: {}", source, e.what()));
  }
}

std::string Advice(const GuidanceRow& guidance) {
  const std::string places = fmt::format("{} places look alike", guidance.rivals + 1);
  if (!guidance.drive_to)
    return places + "; no room in reach tells them apart: say as closely as you can where the robot starts (--near, --room)";
  const DriveToRow& d = *guidance.drive_to;
  const double bearing_deg = d.bearing_rad * 180 / std::numbers::pi;
  std::vector<std::string> names;
  for (const std::string& name : d.room_names) {
    const std::string quoted = name.empty() ? "no room" : fmt::format("`{}`", name);
    if (std::find(names.begin(), names.end(), quoted) == names.end()) names.push_back(quoted);
  }
  return fmt::format(
      "{}; drive into the room {:.0f} m away, first {:.0f} degrees to the {}: it tells {} of them from the best (it may be {})", places,
      d.distance_m, std::abs(bearing_deg), bearing_deg < 0 ? "right" : "left", d.rivals_split, fmt::join(names, " or "));
}

}  // namespace plumb::tools
