// Walls along arcs that are drawn as one line.
#pragma once

#include <array>
#include <vector>

#include "schema/agraph.h"

namespace plumb::compiler {

struct ArcBand {
  std::vector<Eigen::Vector2d> outline;  // closed: steps along one side, and back along the other
  std::array<Arc, 2> sides;
};

// The strip within `half_m` of an arc, whose radius is greater than that, longer by `before_m` and `after_m` at its ends; of more than half
// a circle in two parts. All in metres.
[[nodiscard]] std::vector<ArcBand> BandsAlong(const Arc& arc, double half_m, double before_m, double after_m);

}  // namespace plumb::compiler
