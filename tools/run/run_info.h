// run.json: which plan, which recording, which options and versions a run was made with, and what came out of it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "schema/agraph.h"
#include "schema/error.h"

namespace plumb::tools {

// How a run at the recording's own pace (`plumb localize --rate`) kept up with it.
struct Pace {
  double rate = 0;                                // times real time
  double latency_p50_ms = 0, latency_p99_ms = 0;  // from a scan's end to its pose
  size_t held_solves = 0, unmapped_scans = 0;     // runtime/localizer/online_localizer.h
};
[[nodiscard]] Pace PaceOf(std::vector<double> latencies_ms);  // the percentiles

struct RunInfo {
  std::string plumb_version;
  std::string plan_path;    // absolute: the .agraph that was localized in
  std::string plan_source;  // the drawing it was compiled from
  std::string plan_source_sha256;
  std::string recording_path;
  std::string mode = "dis";     // dis | is | uc | so: what was estimated
  std::vector<Option> options;  // flags of `plumb localize`, as given or by default: values are JSON literals, empty where there is none

  // Summary.
  size_t scans = 0, localized_scans = 0, unreadable_scans = 0;
  size_t untimed_scans = 0;                  // without usable per-point times: deskew off
  bool planar = false;                       // of a planar laser: heights in the trajectory are a convention
  size_t unordered_scans = 0;                // stamps not later than an earlier one's: left out
  bool interrupted = false;                  // before the recording's end
  std::optional<double> time_to_localize_s;  // from the first scan's stamp to that of the first `localized` verdict
  double duration_s = 0;                     // from the first scan's stamp to the last one's
  size_t keyframes = 0;
  size_t deviated_walls = 0, missing_walls = 0, unplanned_walls = 0;
  double range_bias_m = 0;  // estimated common bias of the sensor's ranges
  double ms_per_scan = 0;   // mean over all stages
  std::optional<Pace> pace;
  std::string matcher = "wall";  // wall | graph: what found the robot in the plan
  std::string last_reason;       // why it did not localize; empty if it did
};

[[nodiscard]] std::string RunInfoToJson(const RunInfo& info);
// Errors: kBadRunFolder.
[[nodiscard]] Expected<RunInfo> ParseRunInfo(const std::string& json, const std::string& source);
[[nodiscard]] Expected<RunInfo> ReadRunInfo(const std::string& run_folder);

}  // namespace plumb::tools
