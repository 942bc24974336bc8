#include "tools/run/run_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "runtime/numerics/rounded.h"
#include "schema/files.h"

namespace plumb::tools {

namespace {

using Json = nlohmann::ordered_json;

// Text that is no JSON, as bytes of another encoding in a path, stays text.
Json FromLiteral(const std::string& literal) {
  if (literal.empty()) return nullptr;
  Json value = Json::parse(literal, nullptr, false);
  return value.is_discarded() ? Json(literal) : value;
}

}  // namespace

Pace PaceOf(std::vector<double> latencies_ms) {
  Pace pace;
  if (latencies_ms.empty()) return pace;
  std::sort(latencies_ms.begin(), latencies_ms.end());
  const auto percentile = [&](size_t percent) { return latencies_ms[(latencies_ms.size() - 1) * percent / 100]; };
  pace.latency_p50_ms = percentile(50);
  pace.latency_p99_ms = percentile(99);
  return pace;
}

std::string RunInfoToJson(const RunInfo& info) {
  Json out;
  out["version"] = 1;
  out["plumb"] = info.plumb_version;
  out["plan"] = {{"path", info.plan_path}, {"source", info.plan_source}, {"source_sha256", info.plan_source_sha256}};
  out["recording"] = info.recording_path;
  out["mode"] = info.mode;
  out["options"] = Json::object();
  for (const Option& o : info.options) out["options"][o.name] = FromLiteral(o.value);
  Json summary;
  summary["scans"] = info.scans;
  summary["localized_scans"] = info.localized_scans;
  summary["unreadable_scans"] = info.unreadable_scans;
  summary["untimed_scans"] = info.untimed_scans;
  summary["planar"] = info.planar;
  summary["unordered_scans"] = info.unordered_scans;
  summary["interrupted"] = info.interrupted;
  summary["time_to_localize_s"] = info.time_to_localize_s ? Json(runtime::Rounded(*info.time_to_localize_s, 1e3)) : Json(nullptr);
  summary["duration_s"] = runtime::Rounded(info.duration_s, 1e3);
  summary["keyframes"] = info.keyframes;
  summary["deviated_walls"] = info.deviated_walls;
  summary["missing_walls"] = info.missing_walls;
  summary["unplanned_walls"] = info.unplanned_walls;
  summary["range_bias_m"] = runtime::Rounded(info.range_bias_m, 1e6);
  summary["ms_per_scan"] = runtime::Rounded(info.ms_per_scan, 1e3);
  if (info.pace) {
    summary["pace"] = {{"rate", info.pace->rate},
                       {"latency_p50_ms", runtime::Rounded(info.pace->latency_p50_ms, 1e3)},
                       {"latency_p99_ms", runtime::Rounded(info.pace->latency_p99_ms, 1e3)},
                       {"held_solves", info.pace->held_solves},
                       {"unmapped_scans", info.pace->unmapped_scans}};
  }
  summary["matcher"] = info.matcher;
  summary["last_reason"] = info.last_reason;
  out["summary"] = std::move(summary);
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Expected<RunInfo> ParseRunInfo(const std::string& json, const std::string& source) {
  try {
    const Json root = Json::parse(json);
    if (root.at("version") != 1) return Fail(ErrorCode::kBadRunFolder, fmt::format("`{}` has another version than 1", source));
    RunInfo info;
    root.at("plumb").get_to(info.plumb_version);
    const Json& plan = root.at("plan");
    plan.at("path").get_to(info.plan_path);
    plan.at("source").get_to(info.plan_source);
    plan.at("source_sha256").get_to(info.plan_source_sha256);
    root.at("recording").get_to(info.recording_path);
    info.mode = root.value("mode", info.mode);
    for (const auto& [name, value] : root.at("options").items()) info.options.push_back({name, value.is_null() ? "" : value.dump()});
    const Json& summary = root.at("summary");
    summary.at("scans").get_to(info.scans);
    summary.at("localized_scans").get_to(info.localized_scans);
    info.unreadable_scans = summary.value("unreadable_scans", size_t{0});
    info.untimed_scans = summary.value("untimed_scans", size_t{0});
    info.planar = summary.value("planar", false);
    info.unordered_scans = summary.value("unordered_scans", size_t{0});
    info.interrupted = summary.value("interrupted", false);
    if (!summary.at("time_to_localize_s").is_null()) info.time_to_localize_s = summary.at("time_to_localize_s").get<double>();
    summary.at("duration_s").get_to(info.duration_s);
    summary.at("keyframes").get_to(info.keyframes);
    summary.at("deviated_walls").get_to(info.deviated_walls);
    info.missing_walls = summary.value("missing_walls", size_t{0});
    info.unplanned_walls = summary.value("unplanned_walls", size_t{0});
    summary.at("range_bias_m").get_to(info.range_bias_m);
    summary.at("ms_per_scan").get_to(info.ms_per_scan);
    if (const auto pace = summary.find("pace"); pace != summary.end()) {
      info.pace = Pace{pace->at("rate").get<double>(), pace->at("latency_p50_ms").get<double>(), pace->at("latency_p99_ms").get<double>(),
                       pace->at("held_solves").get<size_t>(), pace->at("unmapped_scans").get<size_t>()};
    }
    info.matcher = summary.value("matcher", info.matcher);
    summary.at("last_reason").get_to(info.last_reason);
    return info;
  } catch (const Json::exception& e) {
    return Fail(ErrorCode::kBadRunFolder, fmt::format("`{}` is no run.json: {}", source, e.what()));
  }
}

Expected<RunInfo> ReadRunInfo(const std::string& run_folder) {
  const std::string path = (std::filesystem::path(run_folder) / "run.json").string();
  const auto text = ReadFileText(path);
  if (!text) return Fail(ErrorCode::kBadRunFolder, fmt::format("`{}` is no run folder: {}", run_folder, text.error().message));
  return ParseRunInfo(*text, path);
}

}  // namespace plumb::tools
