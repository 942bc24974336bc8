// truth.json and truth.tum of a recording folder: what the building and the drive really were.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "runtime/sources/recording.h"
#include "schema/error.h"
#include "schema/ids.h"

namespace plumb::tools {

struct SurfaceTruth {
  double translation_m = 0;  // at the planned surface's midpoint, + along its planned normal
  double rotation_deg = 0;   // about +z, + counter-clockwise
};

// One physical wall that was built off its plan.
struct WallTruth {
  std::string guid;
  double translation_m = 0, rotation_deg = 0;
  std::map<SurfaceId, SurfaceTruth> surfaces;
  std::string name = {};  // empty: not recorded
  WallId wall = {};       // in the plan; invalid: not recorded
  [[nodiscard]] bool deviates() const;
};

// A planned wall that was not built.
struct MissingTruth {
  std::string guid;
  double rays_through = 0;  // that went right through its place
  WallId wall = {};         // in the plan; invalid: not recorded
};

// A wall that was built and is not in the plan.
struct UnplannedTruth {
  std::vector<Eigen::Vector2d> polygon;  // plan frame
  double points = 0;                     // returns from it
};

// A doorway as built.
struct DoorwayTruth {
  DoorwayId id;
  std::string guid;
  double shift_m = 0;            // along its wall, + to the left of who passes from room_a to room_b
  double width_deviation_m = 0;  // + wider
  double rays_through = 0;
};

struct Truth {
  runtime::Trajectory trajectory;  // sensor in the plan frame
  std::vector<WallTruth> walls;    // in the file's order; walls that are not listed are as planned
  std::vector<MissingTruth> missing;
  std::vector<UnplannedTruth> unplanned;
  std::vector<DoorwayTruth> doorways;           // all that may be judged; empty: not recorded
  std::map<SurfaceId, double> surface_points;   // returns that hit each surface; empty: not recorded
  std::map<SurfaceId, double> surface_seen_m2;  // what they came from of it, in cells of 10 cm; empty: not recorded
  std::string plan_source_sha256;               // of the plan that the recording was simulated in; empty: not recorded
  bool has_walls = false;                       // false: the recording has no truth.json
};

// Errors: kNotARecording, with the key.
[[nodiscard]] Expected<Truth> ParseTruth(const std::string& json, const std::string& source);

// truth.tum must exist, truth.json may. Errors: kNotARecording, kBadTrajectory.
[[nodiscard]] Expected<Truth> ReadTruth(const std::string& recording_folder);

}  // namespace plumb::tools
