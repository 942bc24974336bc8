// Upright boxes in the house as built: clutter, walls that are in no plan.
#pragma once

#include "schema/agraph.h"
#include "tools/simulate/rectangle.h"

namespace plumb::tools {

struct Box {
  Rectangle footprint;
  double z_min_m = 0, z_max_m = 0;
};

// Twelve triangles of `element`, plan frame.
void AddBox(AGraph& house, const Box& box, uint32_t element);

}  // namespace plumb::tools
