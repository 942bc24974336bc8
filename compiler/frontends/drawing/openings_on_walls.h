// Openings at symbols that no gap between walls' ends is at. Private to openings.cc.
#pragma once

#include <optional>

#include "compiler/frontends/drawing/openings.h"

namespace plumb::compiler {

// From a to b in a straight wall that goes on behind the symbol.
[[nodiscard]] std::optional<DrawnOpening> OpeningOverWall(const Outline& outline, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

// Between walls that have no ends there, as across a corridor; these may stand as far as `slack_m` twice beyond a and b.
[[nodiscard]] std::optional<DrawnOpening> OpeningBetweenWalls(const Outline& outline, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                                              double slack_m);

}  // namespace plumb::compiler
