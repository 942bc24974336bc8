// Jambs of doorways in a corner: the face of the next wall.
#pragma once

#include <optional>

#include "runtime/deviations/built_doorway.h"
#include "runtime/optimization/joint_optimizer.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// The straight face of another wall that bounds the opening on that side (-1: at lower u, 1: at higher), within 5 cm of the planned clear
// opening; none: there is no such face. `planned`: of the doorway's own wall as planned. O(surfaces).
[[nodiscard]] SurfaceId CornerBeside(const AGraph& plan, const BuiltDoorway& planned, double side);

struct CornerJamb {
  double x_m = 0, sigma_m = 0;  // as of jamb.h: how far the built face stands into the opening beyond where it is planned
};

// Where the built face meets the doorway's middle line; `wall`: of the face. None: it is an end of its wall, whose place along itself
// nobody measured, or the wall turned away.
[[nodiscard]] std::optional<CornerJamb> PlaceCorner(const AGraph& plan, const BuiltDoorway& planned, const BuiltDoorway& built, double side,
                                                    SurfaceId face, const WallEstimate& wall);

}  // namespace plumb::runtime
