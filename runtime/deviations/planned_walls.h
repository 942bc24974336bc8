// Which planned wall a wall that matched nothing may be.
#pragma once

#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/deviations/panel.h"
#include "schema/agraph.h"

namespace plumb::runtime {

class PlannedWalls {
 public:
  PlannedWalls(const AGraph& plan, const std::vector<Match>& matches);

  // Is the planned wall nearest to the panel one that nothing was matched to? Then the panel may be that wall, built too far off to be
  // recognized. Only walls beside the panel that are at most `max_distance_m` off and 30 degrees turned count; a turned wall may be as
  // close at the panel's middle or at its own. O(walls).
  [[nodiscard]] bool MayBeUnmatchedOne(const Panel& panel, double max_distance_m) const;

 private:
  const AGraph& plan_;
  std::vector<bool> matched_;  // per wall
};

}  // namespace plumb::runtime
