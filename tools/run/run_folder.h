// The folder that `plumb localize` writes and that evaluate and report read: verdicts, timing, deviations.
// Tries are in tries_json.h. Trajectories are read and written by runtime/sources/recording.h, run.json by run_info.h.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "runtime/sources/recording.h"
#include "schema/error.h"
#include "schema/ids.h"
#include "tools/run/tries_json.h"

namespace plumb::tools {

// One line of verdicts.csv: the verdict on one scan.
struct VerdictRow {
  double stamp_s = 0;   // start of the sweep
  std::string verdict;  // searching | ambiguous | localized | lost
  int hypotheses = 0;
};

// One line of timing.csv: how long a stage took on one scan.
struct TimingRow {
  double stamp_s = 0;
  std::string stage;
  double ms = 0;
};

// One entry of `surfaces` in deviations.json. Translation along the planned normal, rotation about +z; names and units as in the file.
struct SurfaceEntry {
  SurfaceId id;
  std::string wall_guid, status;  // as_planned | deviated | missing | unobserved
  double translation_m = 0, sigma_translation_m = 0, rotation_deg = 0, sigma_rotation_deg = 0, tilt_deg = 0;
  double p_deviated = 0, observed_m2 = 0, points = 0;
  WallId wall = {};           // in the plan; invalid: none, or an older run, which does not tell
  std::string unjudged = {};  // why it is unobserved; empty: it is not, or an older run
};

struct RoomEntry {
  RoomId id;
  std::string name, guid, status;
  Eigen::Vector2d translation_m = Eigen::Vector2d::Zero();
  double rotation_deg = 0, sigma_m = 0;
};

struct UnplannedEntry {
  std::vector<Eigen::Vector2d> polygon;  // plan frame
  double height_m = 0;
  RoomId room;  // that it stands in
};

// Of a doorway: what is not known is 0.
struct DoorwayEntry {
  DoorwayId id;
  std::string guid, status;               // as_planned | deviated | missing (walled up) | unobserved
  double width_m = 0;                     // planned
  double shift_m = 0, sigma_shift_m = 0;  // along its wall, + to the left of who passes from room_a to room_b
  double width_deviation_m = 0, sigma_width_m = 0, p_deviated = 0;
};

struct Deviations {
  std::string gauge;
  std::vector<SurfaceEntry> surfaces;
  std::vector<RoomEntry> rooms;
  std::vector<UnplannedEntry> unplanned = {};
  std::vector<DoorwayEntry> doorways = {};  // empty in older runs
};

// Text forms; stamps with nine decimals as in scan file names.
[[nodiscard]] std::string VerdictsToCsv(const std::vector<VerdictRow>& rows);
[[nodiscard]] std::string TimingToCsv(const std::vector<TimingRow>& rows);

// `source` names the file in errors. Errors: kBadRunFolder, with the line or the key.
[[nodiscard]] Expected<std::vector<VerdictRow>> ParseVerdicts(const std::string& csv, const std::string& source);
[[nodiscard]] Expected<Deviations> ParseDeviations(const std::string& json, const std::string& source);

// What a run left behind.
struct Run {
  runtime::Trajectory online;    // trajectory.tum: empty if it never localized
  runtime::Trajectory smoothed;  // trajectory_smoothed.tum
  std::vector<VerdictRow> verdicts;
  Deviations deviations;
  std::vector<TryRow> tries = {};  // hypotheses.json: empty if it is not there
};

// Errors: kBadRunFolder (not written by `plumb localize`, or a file of it is missing or damaged).
[[nodiscard]] Expected<Run> ReadRun(const std::string& folder);

}  // namespace plumb::tools
