// Which built walls were found to deviate, which were missed, which were accused wrongly.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/evaluate/truth.h"
#include "tools/run/run_folder.h"

namespace plumb::tools {

enum class WallOutcome : uint8_t {
  kFound,       // deviates, and a surface of it is reported `deviated`, by the right amount
  kInaccurate,  // the same, but the displacement is off by more than two of its sigmas and more than 4 cm
  kMissed,      // deviates and was observed, but is reported as planned (or missing)
  kUnjudged,    // deviates and was observed, but the run calls it `unobserved`
  kUnobserved,  // deviates, but the sensor saw too little of it
  kFalse,       // reported as deviating, but stands as planned
};
[[nodiscard]] const char* WallOutcomeName(WallOutcome outcome);  // found | inaccurate | missed | unjudged | unobserved | false

struct WallResult {
  WallId wall;             // in the plan; invalid: not recorded
  std::string guid, name;  // name: as truth.json has it; empty: not recorded
  WallOutcome outcome = WallOutcome::kMissed;
  SurfaceId surface;  // found and inaccurate: of the reported surfaces that were observed (of all if none was) that with the largest error;
                      // false: likewise, with the largest report; else none
  double true_translation_m = 0, true_rotation_deg = 0;          // of that surface, or of the wall where there is none
  double measured_translation_m = 0, measured_rotation_deg = 0;  // found, inaccurate and false only
  double sigma_translation_m = 0;
  double error_translation_m = 0, error_rotation_deg = 0;  // absolute; found and inaccurate only
  [[nodiscard]] bool measured() const { return outcome == WallOutcome::kFound || outcome == WallOutcome::kInaccurate; }
};

// One entry per wall that deviates or is reported to (missing walls are CompareMissing()'s), by outcome, then by guid and id. A surface
// belongs to the wall of which truth.json lists it, else to that of its wall_id, or where an older run or recording does not tell that, of
// its wall_guid; one that tells neither is a wall of its own. A wall counts as observed when at least `min_points` returns hit one of its
// surfaces, on at least `min_seen_m2` (truth.json; recordings of older simulations tell the returns alone), or where that was not recorded,
// when the run says so.
[[nodiscard]] std::vector<WallResult> CompareWalls(const Truth& truth, const Deviations& reported, double min_points, double min_seen_m2);

// Whether the surface is of that wall: by id where both are known, else by guid; plans other than IFC have no guids.
[[nodiscard]] bool IsOfWall(const SurfaceEntry& surface, WallId wall, const std::string& guid);

}  // namespace plumb::tools
