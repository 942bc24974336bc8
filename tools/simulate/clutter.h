// Boxes that stand about in the house and are in no plan.
#pragma once

#include "tools/simulate/as_built.h"

namespace plumb::tools {

// Adds up to `boxes` boxes to the house, where they leave a way past to every room; returns how many found a place.
[[nodiscard]] int AddClutter(AsBuilt& built, StoreyId storey, int boxes, uint64_t seed);

}  // namespace plumb::tools
