// Walls that were built and are in no plan: upright surfaces of the map that match nothing and stand as high as walls do.
#pragma once

#include <string>
#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/mapping/sgraph.h"
#include "runtime/optimization/joint_optimizer.h"
#include "schema/agraph.h"

namespace plumb::runtime {

struct UnplannedOptions {
  double min_length_m = 1.0;
  double below_ceiling_m = 0.3;       // a wall reaches to this far below the ceiling seen there, ...
  double min_height_m = 2.2;          // ... or, where none was seen, as high above the floor: above the tallest furniture
  // Both faces of a thin wall were seen, but its top was out of the sensor's sight: then one face seen so high is enough if no line of
  // sight goes over either.
  double min_seen_height_m = 1.4;
  double max_bottom_m = 0.5;          // above the floor: a wall stands on it
  double max_thickness_m = 0.5;       // between the faces of one wall, ...
  double max_thin_m = 0.25;           // ... of one whose top was not seen: shelves and cupboards are deeper
  double single_thickness_m = 0.1;    // stated where only one face was seen
  double plan_gate_m = 0.3;           // what the plan has as close as this and parallel, the surface is taken for, ...
  double wall_gate_m = 0.65;          // ... and up to here it may be what stands before or behind a planned wall
  double max_passed_ratio = 0.1;      // of the lines of sight that meet it
  int min_keyframes = 3;
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

struct UnplannedWall {
  std::vector<Eigen::Vector2d> polygon;  // footprint, plan frame, counter-clockwise
  double height_m = 0;                   // seen, above the floor of the room ...
  RoomId room;                           // ... that it stands in
};

// Two findings of one wall, each of which may be of a part of it: along one line, to 10 degrees and 25 cm, and beside each other.
[[nodiscard]] bool SameWall(const UnplannedWall& a, const UnplannedWall& b);

// Only what stands in rooms of the plan: of what is outside, the plan says nothing. What may be furniture, the reflection in a mirror or
// pane, or a planned wall that was not recognized is left out: also what the nearest planned wall may be that nothing was matched to. None
// in a map of a planar laser. In the order of map surfaces. O(map surfaces^2 + keyframe points * surfaces passed). Deterministic.
[[nodiscard]] std::vector<UnplannedWall> FindUnplannedWalls(const SGraph& map, const AGraph& plan, const std::vector<Match>& matches,
                                                            const JointResult& estimate, const UnplannedOptions& options = {});

}  // namespace plumb::runtime
