// What the graph says on a scan, and of the building after a solve while the robot drives.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/deviations/deviations.h"

namespace plumb::runtime {

enum class Verdict : uint8_t { kSearching, kAmbiguous, kLocalized, kLost };
[[nodiscard]] const char* VerdictName(Verdict verdict);  // searching | ambiguous | localized | lost

struct EstimateUpdate {
  double stamp_s = 0;  // of the newest scan that it rests on
  Verdict verdict = Verdict::kSearching;
  std::optional<Eigen::Isometry3d> T_plan_map;  // none while the robot is not localized
  DeviationReport deviations;  // as far as known by then; nothing observed without a place in the plan
  bool requested = false;      // by RequestUpdate(); else by itself
};

// Called on the thread that works on the graph, which waits for it.
using UpdateSink = std::function<void(const EstimateUpdate&)>;

// What the lines so far said; empty before the first.
struct ToldDeviations {
  std::vector<SurfaceDeviation> surfaces;
  std::vector<DoorwayDeviation> doorways;
};

// One line of JSON, with the line's end: t, verdict, T_plan_map as [x, y, z, yaw_deg] or null, and those surfaces and doorways that differ
// from what was told before by status, 1 mm, 0.1 deg or 0.01 of probability. `told` is brought up to date.
[[nodiscard]] std::string UpdateToJson(const EstimateUpdate& update, ToldDeviations& told);

}  // namespace plumb::runtime
