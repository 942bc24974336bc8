// Which doorways were found to be elsewhere or of another width, which were missed, which were accused wrongly.
#pragma once

#include <string>
#include <vector>

#include "tools/evaluate/truth.h"
#include "tools/evaluate/wall_results.h"
#include "tools/run/run_folder.h"

namespace plumb::tools {

// Outcomes as of walls: a doorway deviates if its shift or its width is off by kDeviates_m or more; reported as deviating it is false if
// neither is by half of that.
struct DoorwayResult {
  static constexpr double kDeviates_m = 0.03;

  DoorwayId id;
  std::string guid;
  WallOutcome outcome = WallOutcome::kMissed;
  double true_shift_m = 0, true_width_deviation_m = 0;
  bool measured = false;  // the run says how far it is off, deviated or as planned
  double shift_m = 0, sigma_shift_m = 0, width_deviation_m = 0, sigma_width_m = 0;
};

struct DoorwayScore {
  std::vector<DoorwayResult> results;  // of those that deviate or are called so, by outcome, then by id
  size_t measured = 0;                 // doorways, deviating or not
  double mean_error_m = 0, max_error_m = 0;  // over both numbers of these
  double coverage = 1;                 // share of them within two of their sigmas
  double precision = 1, recall = 1;    // 1 where there is nothing reported, nothing to find

  [[nodiscard]] size_t Count(WallOutcome outcome) const;
};

// A doorway is observed where `min_points` of the counted rays went through it.
[[nodiscard]] DoorwayScore CompareDoorways(const Truth& truth, const Deviations& reported, double min_points, bool localized);

}  // namespace plumb::tools
