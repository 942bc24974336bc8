// Rooms that a drawing outlines and names, as plans of occupancy do, without saying so by its layers.
#pragma once

#include "compiler/frontends/drawing/drawing.h"

namespace plumb::compiler {

struct RoomOutlineOptions {
  double min_area_m2 = 1.5;  // smaller ones are tags
  size_t min_rooms = 3;      // fewer are frames around titles
};

// Adds the smallest closed outline around each text as a space, unless it holds another such outline. The drawing is in metres.
void AddOutlinedRooms(Drawing& drawing, const RoomOutlineOptions& options = {});

}  // namespace plumb::compiler
