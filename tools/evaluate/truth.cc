#include "tools/evaluate/truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "schema/files.h"

namespace plumb::tools {
namespace {

using Json = nlohmann::json;

bool IsOff(double translation_m, double rotation_deg) { return std::abs(translation_m) > 1e-6 || std::abs(rotation_deg) > 1e-6; }

std::vector<Eigen::Vector2d> ParsePolygon(const Json& json) {
  std::vector<Eigen::Vector2d> polygon;
  for (const Json& p : json) polygon.emplace_back(p.at(0).get<double>(), p.at(1).get<double>());
  return polygon;
}

WallId ParseWallId(const Json& json) { return json.contains("wall_id") ? WallId(json.at("wall_id").get<uint32_t>()) : WallId(); }

WallTruth ParseWall(const Json& json) {
  WallTruth wall;
  json.at("wall_guid").get_to(wall.guid);
  wall.name = json.value("wall_name", "");
  wall.wall = ParseWallId(json);
  json.at("translation_m").get_to(wall.translation_m);
  json.at("rotation_deg").get_to(wall.rotation_deg);
  for (const Json& s : json.at("surfaces")) {
    wall.surfaces[SurfaceId(s.at("id").get<uint32_t>())] = {s.at("translation_m").get<double>(), s.at("rotation_deg").get<double>()};
  }
  return wall;
}

// Numbers by surface id. Empty if fine, else what is wrong.
std::string ParseOfSurfaces(const Json& root, const char* name, std::map<SurfaceId, double>& out) {
  const Json object = root.value(name, Json::object());
  for (const auto& [key, number] : object.items()) {
    uint32_t id = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), id);
    if (error != std::errc() || end != key.data() + key.size())
      return fmt::format("`{}` has the key `{}`; keys are surface ids", name, key);
    out[SurfaceId(id)] = number.get<double>();
  }
  return {};
}

}  // namespace

bool WallTruth::deviates() const {
  return IsOff(translation_m, rotation_deg) || std::any_of(surfaces.begin(), surfaces.end(), [](const auto& entry) {
           return IsOff(entry.second.translation_m, entry.second.rotation_deg);
         });
}

Expected<Truth> ParseTruth(const std::string& json, const std::string& source) {
  try {
    const Json root = Json::parse(json);
    if (root.at("version") != 1) return Fail(ErrorCode::kNotARecording, fmt::format("`{}` has another version than 1", source));
    Truth truth;
    truth.has_walls = true;
    if (root.value("incomplete", false))
      return Fail(ErrorCode::kNotARecording, fmt::format("`{}`: the simulation was broken off; simulate it again", source));
    if (const auto plan = root.find("plan"); plan != root.end()) truth.plan_source_sha256 = plan->value("sha256", "");
    for (const Json& wall : root.at("walls")) truth.walls.push_back(ParseWall(wall));
    for (const Json& m : root.value("missing", Json::array())) {
      truth.missing.push_back({m.at("wall_guid"), m.at("rays_through"), ParseWallId(m)});
    }
    for (const Json& u : root.value("unplanned", Json::array())) {
      truth.unplanned.push_back({ParsePolygon(u.at("polygon")), u.at("points")});
      if (truth.unplanned.back().polygon.size() < 3)
        return Fail(ErrorCode::kNotARecording, fmt::format("`{}`: a polygon of `unplanned` has fewer than 3 corners", source));
    }
    for (const Json& d : root.value("doorways", Json::array())) {
      truth.doorways.push_back(
          {DoorwayId(d.at("id").get<uint32_t>()), d.value("guid", ""), d.at("shift_m"), d.at("width_deviation_m"), d.at("rays_through")});
    }
    for (const auto& [name, of_surfaces] :
         {std::pair("surface_points", &truth.surface_points), std::pair("surface_seen_m2", &truth.surface_seen_m2)}) {
      if (const std::string fault = ParseOfSurfaces(root, name, *of_surfaces); !fault.empty())
        return Fail(ErrorCode::kNotARecording, fmt::format("`{}`: {}", source, fault));
    }
    return truth;
  } catch (const Json::exception& e) {
    return Fail(ErrorCode::kNotARecording, fmt::format("`{}` is no truth file: {}", source, e.what()));
  }
}

Expected<Truth> ReadTruth(const std::string& recording_folder) {
  const std::filesystem::path folder(recording_folder);
  const std::string tum = (folder / "truth.tum").string(), json = (folder / "truth.json").string();
  Truth truth;
  if (std::filesystem::exists(json)) {
    const auto text = ReadFileText(json);
    if (!text) return tl::unexpected(text.error());
    auto parsed = ParseTruth(*text, json);
    if (!parsed) return parsed;
    truth = std::move(*parsed);
  }
  if (!std::filesystem::exists(tum)) {
    return Fail(ErrorCode::kNotARecording,
                fmt::format("`{}` has no truth.tum; without it there is nothing to compare with", recording_folder));
  }
  auto trajectory = runtime::ReadTum(tum);
  if (!trajectory) return tl::unexpected(trajectory.error());
  truth.trajectory = std::move(*trajectory);
  return truth;
}

}  // namespace plumb::tools
