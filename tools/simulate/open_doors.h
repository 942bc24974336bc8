// Inner doors stand open while the robot drives: their leaves are taken out, frames stay.
#pragma once

#include "schema/agraph.h"

namespace plumb::tools {

// The plan without what stands in the clear opening of doorways between two rooms (connected pieces of the door's own elements that
// block the passage). Doors to the outside stay closed.
[[nodiscard]] AGraph WithInnerDoorsOpen(const AGraph& plan);

}  // namespace plumb::tools
