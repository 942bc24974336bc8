#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tools/evaluate/evaluate.h"

namespace plumb::tools {
namespace {

using Json = nlohmann::ordered_json;

double Degrees(double rad) { return rad * 180 / std::numbers::pi; }

Json ErrorsToJson(const PoseErrors& e) {
  return {{"poses", e.count},
          {"without_truth", e.without_truth},
          {"ate_rmse_m", e.rmse_m},
          {"ate_mean_m", e.mean_m},
          {"ate_max_m", e.max_m},
          {"yaw_rmse_deg", Degrees(e.yaw_rmse_rad)},
          {"yaw_max_deg", Degrees(e.yaw_max_rad)},
          {"tilt_rmse_deg", Degrees(e.tilt_rmse_rad)},
          {"tilt_max_deg", Degrees(e.tilt_max_rad)}};
}

Json WallToJson(const WallResult& w) {
  Json out;
  out["wall_id"] = w.wall.valid() ? Json(w.wall.value) : Json(nullptr);
  out["wall_guid"] = w.guid;
  if (!w.name.empty()) out["wall_name"] = w.name;
  out["outcome"] = WallOutcomeName(w.outcome);
  out["surface"] = w.surface.valid() ? Json(w.surface.value) : Json(nullptr);
  out["true_translation_m"] = w.true_translation_m;
  out["true_rotation_deg"] = w.true_rotation_deg;
  if (w.surface.valid()) {
    out["translation_m"] = w.measured_translation_m;
    out["sigma_translation_m"] = w.sigma_translation_m;
    out["rotation_deg"] = w.measured_rotation_deg;
  }
  if (w.measured()) {
    out["error_translation_m"] = w.error_translation_m;
    out["error_rotation_deg"] = w.error_rotation_deg;
  }
  return out;
}

// What people know the wall by; plans other than IFC have neither names nor guids.
std::string WallLabel(const WallResult& w) {
  if (!w.name.empty()) return w.name;
  return w.guid.empty() && w.wall.valid() ? fmt::format("wall {}", w.wall.value) : w.guid;
}

std::string PoseLine(const char* name, const PoseErrors& e) {
  if (e.count == 0) return fmt::format("{:<22} none has a truth\n", name);
  return fmt::format(
      "{:<22} ATE rmse {:.3f} m, mean {:.3f} m, max {:.3f} m; yaw rmse {:.2f} deg, max {:.2f} deg; tilt rmse {:.2f} deg, "
      "max {:.2f} deg ({} poses)\n",
      name, e.rmse_m, e.mean_m, e.max_m, Degrees(e.yaw_rmse_rad), Degrees(e.yaw_max_rad), Degrees(e.tilt_rmse_rad), Degrees(e.tilt_max_rad),
      e.count);
}

std::string ChangesLine(const char* name, const std::vector<ChangeResult>& results) {
  return fmt::format("{:<22} {} found, {} missed, {} unobserved, {} false\n", name, Count(results, WallOutcome::kFound),
                     Count(results, WallOutcome::kMissed), Count(results, WallOutcome::kUnobserved), Count(results, WallOutcome::kFalse));
}

// Counts and shares as keys of the object itself, the walls in an array.
void WriteChanges(const std::string& name, const std::vector<ChangeResult>& results, Json& out) {
  for (const WallOutcome outcome : {WallOutcome::kFound, WallOutcome::kMissed, WallOutcome::kUnobserved, WallOutcome::kFalse}) {
    out[name + "_" + WallOutcomeName(outcome)] = Count(results, outcome);
  }
  out[name + "_recall"] = Recall(results);
  out[name + "_precision"] = Precision(results);
  Json& list = out[name] = Json::array();
  for (const ChangeResult& r : results) {
    Json entry = {{"outcome", WallOutcomeName(r.outcome)}};
    if (r.wall.valid()) entry["wall_id"] = r.wall.value;
    if (!r.guid.empty()) entry["wall_guid"] = r.guid;
    for (const Eigen::Vector2d& p : r.polygon) entry["polygon"].push_back({p.x(), p.y()});
    list.push_back(entry);
  }
}

// None where the recording does not say how doorways were built.
void WriteDoorways(const DoorwayScore& score, std::string& out) {
  if (score.measured == 0 && score.results.empty()) return;
  auto write = std::back_inserter(out);
  fmt::format_to(
      write,
      "{:<22} {} found, {} inaccurate, {} missed, {} unjudged, {} unobserved, {} false; {} measured, error {:.3f} m mean, {:.3f} m max, "
      "{:.0f} % within 2 sigma\n",
      "deviated doorways", score.Count(WallOutcome::kFound), score.Count(WallOutcome::kInaccurate), score.Count(WallOutcome::kMissed),
      score.Count(WallOutcome::kUnjudged), score.Count(WallOutcome::kUnobserved), score.Count(WallOutcome::kFalse), score.measured,
      score.mean_error_m, score.max_error_m, 100 * score.coverage);
  for (const DoorwayResult& r : score.results) {
    fmt::format_to(write, "  {:<24} {:<10} shift {:+.3f} m, width {:+.3f} m",
                   r.guid.empty() ? fmt::format("doorway {}", r.id.value) : r.guid, WallOutcomeName(r.outcome), r.true_shift_m,
                   r.true_width_deviation_m);
    if (r.measured) {
      fmt::format_to(write, "; measured {:+.3f} +- {:.3f}, {:+.3f} +- {:.3f}", r.shift_m, r.sigma_shift_m, r.width_deviation_m,
                     r.sigma_width_m);
    }
    out += "\n";
  }
}

Json DoorwayToJson(const DoorwayResult& r) {
  Json out = {{"id", r.id.value},
              {"guid", r.guid},
              {"outcome", WallOutcomeName(r.outcome)},
              {"true_shift_m", r.true_shift_m},
              {"true_width_deviation_m", r.true_width_deviation_m}};
  if (r.measured) {
    out["shift_m"] = r.shift_m;
    out["sigma_shift_m"] = r.sigma_shift_m;
    out["width_deviation_m"] = r.width_deviation_m;
    out["sigma_width_m"] = r.sigma_width_m;
  }
  return out;
}

void WriteDoorways(const DoorwayScore& score, Json& out) {
  for (const WallOutcome outcome : {WallOutcome::kFound, WallOutcome::kMissed, WallOutcome::kInaccurate, WallOutcome::kUnjudged,
                                    WallOutcome::kUnobserved, WallOutcome::kFalse}) {
    out[std::string("doorways_") + WallOutcomeName(outcome)] = score.Count(outcome);
  }
  out["doorways_measured"] = score.measured;
  out["doorways_recall"] = score.recall;
  out["doorways_precision"] = score.precision;
  out["doorways_mean_error_m"] = score.mean_error_m;
  out["doorways_max_error_m"] = score.max_error_m;
  out["doorways_coverage"] = score.coverage;
  out["doorways"] = Json::array();
  for (const DoorwayResult& r : score.results) out["doorways"].push_back(DoorwayToJson(r));
}

void WriteWalls(const Evaluation& e, std::string& out) {
  auto write = std::back_inserter(out);
  fmt::format_to(write, "{:<22} {} found, {} inaccurate, {} missed, {} unjudged, {} unobserved, {} false\n", "deviated walls",
                 e.CountWalls(WallOutcome::kFound), e.CountWalls(WallOutcome::kInaccurate), e.CountWalls(WallOutcome::kMissed),
                 e.CountWalls(WallOutcome::kUnjudged), e.CountWalls(WallOutcome::kUnobserved), e.CountWalls(WallOutcome::kFalse));
  out += ChangesLine("missing walls", e.missing);
  out += ChangesLine("unplanned walls", e.unplanned);
  WriteDoorways(e.doorways, out);
  if (e.walls.empty()) return;
  fmt::format_to(write, "\n{:<24} {:>7} {:<10} {:>10} {:>20} {:>10} {:>9} {:>9} {:>9}\n", "wall", "surface", "outcome", "truth m",
                 "measured m", "error m", "truth deg", "meas. deg", "error deg");
  for (const WallResult& w : e.walls) {
    const bool reported = w.surface.valid(), found = w.measured();
    const auto number = [](bool show, int digits, double value) {
      return show ? fmt::format("{:+.{}f}", value, digits) : std::string("-");
    };
    const std::string measured = reported ? fmt::format("{:+.3f} +- {:.3f}", w.measured_translation_m, w.sigma_translation_m) : "-";
    fmt::format_to(write, "{:<24} {:>7} {:<10} {:>+10.3f} {:>20} {:>10} {:>+9.2f} {:>9} {:>9}\n", WallLabel(w),
                   reported ? fmt::format("{}", w.surface.value) : "-", WallOutcomeName(w.outcome), w.true_translation_m, measured,
                   found ? fmt::format("{:.3f}", w.error_translation_m) : "-", w.true_rotation_deg,
                   number(reported, 2, w.measured_rotation_deg), found ? fmt::format("{:.2f}", w.error_rotation_deg) : "-");
  }
}

}  // namespace

std::string EvaluationToText(const Evaluation& e) {
  std::string out;
  auto write = std::back_inserter(out);
  fmt::format_to(write, "{:<22} {}\n", "time to localize", e.time_to_localize_s ? fmt::format("{:.1f} s", *e.time_to_localize_s) : "never");
  fmt::format_to(write, "{:<22} {} of {} ({:.1f} %)\n", "scans localized", e.localized_scans, e.scans, 100 * e.localized_ratio());
  fmt::format_to(write, "{:<22} {}\n", "wrong fixes",
                 e.wrong_fixes == 0 ? "none" : fmt::format("{} scans, the first at {:.3f} s", e.wrong_fixes, *e.first_wrong_fix_s));
  if (e.in_plane) fmt::format_to(write, "{:<22} in x and y: a planar laser does not know its height\n", "positions compared");
  out += PoseLine("poses as reported", e.online);
  out += PoseLine("poses smoothed", e.smoothed);
  if (e.has_walls) {
    WriteWalls(e, out);
  } else {
    fmt::format_to(write, "{:<22} the recording has no truth.json\n", "deviated walls");
  }
  return out;
}

std::string EvaluationToJson(const Evaluation& e) {
  Json out;
  out["version"] = 1;
  out["scans"] = e.scans;
  out["localized_scans"] = e.localized_scans;
  out["localized_ratio"] = e.localized_ratio();
  out["time_to_localize_s"] = e.time_to_localize_s ? Json(*e.time_to_localize_s) : Json(nullptr);
  out["wrong_fixes"] = e.wrong_fixes;
  out["first_wrong_fix_s"] = e.first_wrong_fix_s ? Json(*e.first_wrong_fix_s) : Json(nullptr);
  out["in_plane"] = e.in_plane;
  out["ate_rmse_m"] = e.online.count > 0 ? Json(e.online.rmse_m) : Json(nullptr);
  out["yaw_rmse_deg"] = e.online.count > 0 ? Json(Degrees(e.online.yaw_rmse_rad)) : Json(nullptr);
  out["tilt_rmse_deg"] = e.online.count > 0 ? Json(Degrees(e.online.tilt_rmse_rad)) : Json(nullptr);
  out["walls_found"] = e.CountWalls(WallOutcome::kFound);
  out["walls_missed"] = e.CountWalls(WallOutcome::kMissed);
  out["walls_inaccurate"] = e.CountWalls(WallOutcome::kInaccurate);
  out["walls_unjudged"] = e.CountWalls(WallOutcome::kUnjudged);
  out["walls_unobserved"] = e.CountWalls(WallOutcome::kUnobserved);
  out["walls_false"] = e.CountWalls(WallOutcome::kFalse);
  out["max_error_translation_m"] = e.max_translation_error_m();
  out["max_error_rotation_deg"] = e.max_rotation_error_deg();
  out["online"] = ErrorsToJson(e.online);
  out["smoothed"] = ErrorsToJson(e.smoothed);
  out["walls"] = Json::array();
  for (const WallResult& w : e.walls) out["walls"].push_back(WallToJson(w));
  WriteChanges("missing", e.missing, out);
  WriteChanges("unplanned", e.unplanned, out);
  WriteDoorways(e.doorways, out);
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace plumb::tools
