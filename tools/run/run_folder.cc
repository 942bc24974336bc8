#include "tools/run/run_folder.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "schema/files.h"

namespace plumb::tools {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kVerdictsHeader = "t,verdict,hypotheses";

// Splits off the text up to `separator`; the rest stays in `text`.
std::string_view Take(std::string_view& text, char separator) {
  const size_t at = text.find(separator);
  const std::string_view head = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
  return head;
}

template <class Number>
std::optional<Number> ParseNumber(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<VerdictRow> ParseVerdictRow(std::string_view line) {
  const auto stamp_s = ParseNumber<double>(Take(line, ','));
  const std::string_view verdict = Take(line, ',');
  const auto hypotheses = ParseNumber<int>(line);
  if (!stamp_s || !hypotheses) return std::nullopt;
  if (verdict != "searching" && verdict != "ambiguous" && verdict != "localized" && verdict != "lost") return std::nullopt;
  return VerdictRow{*stamp_s, std::string(verdict), *hypotheses};
}

// A value that may be null stays at its default; one of another type is an exception.
template <class T>
void Get(const Json& object, const char* key, T& value) {
  const auto found = object.find(key);
  if (found != object.end() && !found->is_null()) found->get_to(value);
}

SurfaceEntry ParseSurface(const Json& json) {
  SurfaceEntry s;
  s.id = SurfaceId(json.at("id").get<uint32_t>());
  json.at("status").get_to(s.status);
  Get(json, "wall_guid", s.wall_guid);
  if (const auto wall = json.find("wall_id"); wall != json.end() && !wall->is_null()) s.wall = WallId(wall->get<uint32_t>());
  Get(json, "translation_m", s.translation_m);
  Get(json, "sigma_translation_m", s.sigma_translation_m);
  Get(json, "rotation_deg", s.rotation_deg);
  Get(json, "sigma_rotation_deg", s.sigma_rotation_deg);
  Get(json, "tilt_deg", s.tilt_deg);
  Get(json, "p_deviated", s.p_deviated);
  Get(json, "observed_m2", s.observed_m2);
  Get(json, "points", s.points);
  Get(json, "unjudged", s.unjudged);
  return s;
}

RoomEntry ParseRoom(const Json& json) {
  RoomEntry r;
  r.id = RoomId(json.at("id").get<uint32_t>());
  json.at("status").get_to(r.status);
  Get(json, "name", r.name);
  Get(json, "guid", r.guid);
  Get(json, "rotation_deg", r.rotation_deg);
  Get(json, "sigma_m", r.sigma_m);
  const Json& t = json.at("translation_m");
  r.translation_m = Eigen::Vector2d(t.at(0).get<double>(), t.at(1).get<double>());
  return r;
}

UnplannedEntry ParseUnplanned(const Json& json) {
  UnplannedEntry wall;
  for (const Json& p : json.at("polygon")) wall.polygon.emplace_back(p.at(0).get<double>(), p.at(1).get<double>());
  Get(json, "height_m", wall.height_m);
  if (json.contains("room")) wall.room = RoomId(json.at("room").get<uint32_t>());
  return wall;
}

DoorwayEntry ParseDoorway(const Json& json) {
  DoorwayEntry d;
  d.id = DoorwayId(json.at("id").get<uint32_t>());
  json.at("status").get_to(d.status);
  Get(json, "guid", d.guid);
  Get(json, "width_m", d.width_m);
  Get(json, "shift_m", d.shift_m);
  Get(json, "sigma_shift_m", d.sigma_shift_m);
  Get(json, "width_deviation_m", d.width_deviation_m);
  Get(json, "sigma_width_m", d.sigma_width_m);
  Get(json, "p_deviated", d.p_deviated);
  return d;
}

// Before the first fix there is no trajectory, and the file holds nothing.
Expected<runtime::Trajectory> ReadRunTrajectory(const std::string& path) {
  const auto text = ReadFileText(path);
  if (!text) return Fail(ErrorCode::kBadRunFolder, text.error().message);
  if (text->empty()) return runtime::Trajectory{};
  return runtime::ReadTum(path);
}

}  // namespace

std::string VerdictsToCsv(const std::vector<VerdictRow>& rows) {
  std::string out = fmt::format("{}\n", kVerdictsHeader);
  for (const VerdictRow& r : rows) fmt::format_to(std::back_inserter(out), "{:.9f},{},{}\n", r.stamp_s, r.verdict, r.hypotheses);
  return out;
}

std::string TimingToCsv(const std::vector<TimingRow>& rows) {
  std::string out = "t,stage,ms\n";
  for (const TimingRow& r : rows) fmt::format_to(std::back_inserter(out), "{:.9f},{},{:.3f}\n", r.stamp_s, r.stage, r.ms);
  return out;
}

Expected<std::vector<VerdictRow>> ParseVerdicts(const std::string& csv, const std::string& source) {
  std::string_view rest = csv;
  if (Take(rest, '\n') != kVerdictsHeader) {
    return Fail(ErrorCode::kBadRunFolder, fmt::format("`{}` does not start with `{}`", source, kVerdictsHeader));
  }
  std::vector<VerdictRow> rows;
  for (size_t line_number = 2; !rest.empty(); ++line_number) {
    const std::string_view line = Take(rest, '\n');
    const auto row = ParseVerdictRow(line);
    if (!row)
      return Fail(ErrorCode::kBadRunFolder, fmt::format("`{}:{}`: `{}` is no line of stamp, verdict, count", source, line_number, line));
    rows.push_back(*row);
  }
  return rows;
}

Expected<Deviations> ParseDeviations(const std::string& json, const std::string& source) {
  try {
    const Json root = Json::parse(json);
    if (root.at("version") != 1) return Fail(ErrorCode::kBadRunFolder, fmt::format("`{}` has another version than 1", source));
    Deviations out;
    Get(root, "gauge", out.gauge);
    for (const Json& surface : root.at("surfaces")) out.surfaces.push_back(ParseSurface(surface));
    for (const Json& room : root.at("rooms")) out.rooms.push_back(ParseRoom(room));
    for (const Json& wall : root.value("unplanned", Json::array())) {
      out.unplanned.push_back(ParseUnplanned(wall));
      if (out.unplanned.back().polygon.size() < 3)
        return Fail(ErrorCode::kBadRunFolder, fmt::format("`{}`: a polygon of `unplanned` has fewer than 3 corners", source));
    }
    for (const Json& doorway : root.value("doorways", Json::array())) out.doorways.push_back(ParseDoorway(doorway));
    return out;
  } catch (const Json::exception& e) {
    return Fail(ErrorCode::kBadRunFolder, fmt::format("`{}` is no deviations file: {}", source, e.what()));
  }
}

Expected<Run> ReadRun(const std::string& folder) {
  const auto path = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
  Run run;
  const auto csv = ReadFileText(path("verdicts.csv"));
  if (!csv) return Fail(ErrorCode::kBadRunFolder, fmt::format("`{}` is no run folder: {}", folder, csv.error().message));
  auto verdicts = ParseVerdicts(*csv, path("verdicts.csv"));
  if (!verdicts) return tl::unexpected(verdicts.error());
  run.verdicts = std::move(*verdicts);

  const auto json = ReadFileText(path("deviations.json"));
  if (!json) return Fail(ErrorCode::kBadRunFolder, json.error().message);
  auto deviations = ParseDeviations(*json, path("deviations.json"));
  if (!deviations) return tl::unexpected(deviations.error());
  run.deviations = std::move(*deviations);

  if (const auto text = ReadFileText(path("hypotheses.json")); text) {
    auto tries = ParseTries(*text, path("hypotheses.json"));
    if (!tries) return tl::unexpected(tries.error());
    run.tries = std::move(*tries);
  }

  auto online = ReadRunTrajectory(path("trajectory.tum"));
  if (!online) return tl::unexpected(online.error());
  run.online = std::move(*online);
  auto smoothed = ReadRunTrajectory(path("trajectory_smoothed.tum"));
  if (!smoothed) return tl::unexpected(smoothed.error());
  run.smoothed = std::move(*smoothed);
  return run;
}

}  // namespace plumb::tools
