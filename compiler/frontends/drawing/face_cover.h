// What stands on the faces of a map of walls and runs.
#pragma once

#include <vector>

#include "compiler/frontends/drawing/line_map.h"
#include "compiler/frontends/drawing/outline.h"
#include "compiler/frontends/drawing/wall_runs.h"

namespace plumb::compiler {

enum class FaceCover : uint8_t { kFree, kRun, kWall };  // kWall: of the outline's walls, but of no run

// By face of the map; the outer one is free. O(n log n), on several threads in large maps.
[[nodiscard]] std::vector<FaceCover> CoverOfFaces(const LineMap& map, const std::vector<WallRun>& runs, const Outline& outline);

}  // namespace plumb::compiler
