// Where a wall has no face: its doorways and windows. What is seen there are leaves, panes and frames, or the room beyond.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "schema/agraph.h"

namespace plumb::runtime {

// Plan frame. `middle` lies on the wall; the opening reaches half its width to either side along it.
struct WallOpening {
  Eigen::Vector2d middle;
  double width_m, z_min_m, z_max_m;
};

// Per wall of the plan.
[[nodiscard]] std::vector<std::vector<WallOpening>> OpeningsOfWalls(const AGraph& plan);

// Is a point of the wall within `margin_m` of an opening? `at` is its coordinate along the unit vector `along`, which runs along the wall.
[[nodiscard]] inline bool InOpening(const std::vector<WallOpening>& openings, const Eigen::Vector2d& along, double at, double z_m,
                                    double margin_m) {
  for (const WallOpening& o : openings) {
    if (std::abs(at - along.dot(o.middle)) < 0.5 * o.width_m + margin_m && z_m > o.z_min_m - margin_m && z_m < o.z_max_m + margin_m)
      return true;
  }
  return false;
}

}  // namespace plumb::runtime
