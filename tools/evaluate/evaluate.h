// Compares a run of `plumb localize` with the truth of its recording.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "schema/error.h"
#include "tools/evaluate/doorway_results.h"
#include "tools/evaluate/pose_errors.h"
#include "tools/evaluate/truth.h"
#include "tools/evaluate/wall_changes.h"
#include "tools/evaluate/wall_results.h"
#include "tools/run/run_folder.h"

namespace plumb::tools {

struct EvaluateOptions {
  double wrong_fix_m = 1.0;       // a pose further off than this while `localized`, ...
  double wrong_fix_rad = 0.3491;  // ... or turned by more than this (20 deg), is a wrong fix
  double max_truth_gap_s = 0.5;   // truth is not interpolated over longer gaps
  double min_points = 200;        // a wall with fewer returns on each surface counts as unobserved, ...
  double min_seen_m2 = 0.5;       // ... and so does one of which they came from less than this of each surface: a sliver
  bool in_plane = false;          // positions are compared in x and y only: a planar laser does not know its height
  // Empty if every field is valid; else names the field, its value and the rule.
  [[nodiscard]] std::string Check() const;
};

struct Evaluation {
  size_t scans = 0, localized_scans = 0;
  std::optional<double> time_to_localize_s;  // first `localized` verdict minus first scan; none: never
  std::optional<double> first_wrong_fix_s;   // stamp of the first pose that is a wrong fix; none: never
  size_t wrong_fixes = 0;                    // scans that are
  bool in_plane = false;                     // as EvaluateOptions
  PoseErrors online, smoothed;
  bool has_walls = false;  // the recording says how the walls were built
  std::vector<WallResult> walls;
  std::vector<ChangeResult> missing, unplanned;
  DoorwayScore doorways;

  [[nodiscard]] double localized_ratio() const {
    return scans == 0 ? 0 : static_cast<double>(localized_scans) / static_cast<double>(scans);
  }
  [[nodiscard]] size_t CountWalls(WallOutcome outcome) const;
  // Over the walls found, accurately or not; 0 if there are none.
  [[nodiscard]] double max_translation_error_m() const;
  [[nodiscard]] double max_rotation_error_deg() const;
};

[[nodiscard]] Evaluation Evaluate(const Run& run, const Truth& truth, const EvaluateOptions& options = {});

// A table for people, and one JSON object with a key per line.
[[nodiscard]] std::string EvaluationToText(const Evaluation& evaluation);
[[nodiscard]] std::string EvaluationToJson(const Evaluation& evaluation);

}  // namespace plumb::tools
