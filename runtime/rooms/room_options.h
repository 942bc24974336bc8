// Options of the upper layers of the S-Graph.
#pragma once

#include <string>

namespace plumb::runtime {

struct RoomOptions {
  double storey_step_m = 1.5;                  // floors are at least this far apart in height
  double band_low_m = 0.2, band_high_m = 1.9;  // above the floor: rays in between make free space. Below lie thresholds, above lintels
  double cell_m = 0.05;                        // of the free space's grid; coarser where a floor would take more than max_cells
  double max_cells = 16e6;                     // 10 bytes each; 200 m x 200 m
  double max_range_m = 15.0;                   // rays count no further than this
  double door_width_m = 1.3;                   // necks up to this width part rooms, ...
  double passage_width_m = 2.5;                // ... wider ones up to this only where a wall runs along both sides of them
  double min_doorway_width_m = 0.5;            // narrower ones are slits: they part rooms but nobody goes through
  double min_room_area_m2 = 1.2;               // smaller ones belong to the room they open into most widely
  [[nodiscard]] std::string Check() const;     // empty, or the field, its value and the rule
};

}  // namespace plumb::runtime
