// Which missing and unplanned walls were found, which were missed, which were made up.
#pragma once

#include <string>
#include <vector>

#include "tools/evaluate/truth.h"
#include "tools/evaluate/wall_results.h"
#include "tools/run/run_folder.h"

namespace plumb::tools {

// Outcomes are kFound, kMissed, kUnobserved (too few lines of sight through a missing wall's place, too few returns from an unplanned one,
// or the run was never `localized` and so can say nothing) and kFalse.
struct ChangeResult {
  std::string guid;  // missing walls only
  WallOutcome outcome = WallOutcome::kMissed;
  std::vector<Eigen::Vector2d> polygon = {};  // unplanned walls only: of the truth, of a false one as reported
  WallId wall = {};                           // missing walls only; invalid: not recorded
};

// A missing wall is found if a surface of it is reported `missing`. Walls are told apart as by CompareWalls(). By outcome, then by guid and
// id.
[[nodiscard]] std::vector<ChangeResult> CompareMissing(const Truth& truth, const Deviations& reported, double min_points, bool localized);

// An unplanned wall is found if reported polygons cover at least half of its length within 10 cm; a reported one of which less than half
// lies within 10 cm of a true one is false. In the truth's order, then the reported one's.
[[nodiscard]] std::vector<ChangeResult> CompareUnplanned(const Truth& truth, const Deviations& reported, double min_points, bool localized);

// Of what was found or missed the share found, of what was reported the share that is true; 1 where there is nothing to find, nothing
// reported.
[[nodiscard]] double Recall(const std::vector<ChangeResult>& results);
[[nodiscard]] double Precision(const std::vector<ChangeResult>& results);
[[nodiscard]] size_t Count(const std::vector<ChangeResult>& results, WallOutcome outcome);

}  // namespace plumb::tools
