// Rooms that a drawing outlines and names, as plans of occupancy do, without saying so by its layers.
#pragma once

#include "compiler/frontends/drawing/drawing.h"

namespace plumb::compiler {

struct RoomOutlineOptions {
  double min_area_m2 = 1.5;     // smaller ones are tags, if they lie within a room
  double min_closet_m2 = 0.3;   // ... and closets or shafts, if they lie beside the rooms
  double max_held_share = 0.3;  // of an outline's area that other rooms in it take; more, and it is a frame
  size_t min_rooms = 3;         // fewer are frames around titles
};

// Adds the smallest closed outline around each text as a space, unless it is a frame around others, and marks its path. The drawing is in
// metres.
void AddOutlinedRooms(Drawing& drawing, const RoomOutlineOptions& options = {});

}  // namespace plumb::compiler
