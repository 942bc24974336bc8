// The round ones among the runs of walls. Private to wall_runs.cc.
#pragma once

#include <vector>

#include "compiler/frontends/drawing/curved_walls.h"
#include "compiler/frontends/drawing/wall_runs.h"

namespace plumb::compiler {

// A wall goes on over its openings and where others meet it. One all the way round is two halves. Without openings assigned.
[[nodiscard]] std::vector<WallRun> FindRoundRuns(const Outline& outline, const std::vector<DrawnOpening>& openings,
                                                 const RunOptions& options);

// The piece of wall that an opening in a curve stands for, where there is no wall beside it.
[[nodiscard]] WallRun RoundPieceFor(const DrawnOpening& opening);

}  // namespace plumb::compiler
