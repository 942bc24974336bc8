// Whether planned walls were built at all: what is seen through the place of a wall, nothing stands there.
#pragma once

#include <string>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/optimization/joint_optimizer.h"
#include "schema/agraph.h"

namespace plumb::runtime {

struct PresenceOptions {
  // A wall that stands this far off its plan is still that wall: only lines that pass all of this on both sides of it say that it is not
  // there.
  double gate_m = 0.65;
  double cell_m = 0.25;     // of the grid on each face
  double margin_m = 0.15;   // about openings and edges: three sigmas of where a line passes, for errors of 3 cm and 0.2 deg at max_sight_m
  double max_sight_m = 12;  // to the wall
  double min_incidence = 0.25;  // sine; flatter lines say nothing
  int min_lines = 3;            // that pass a cell, ...
  int min_keyframes = 2;        // ... and keyframes that they start at; as many lines that end at it
  double min_cell_ratio =
      0.3;  // a cell is open if this share of the lines that meet it pass: furniture may stand before a wall that is not there
  double min_open_ratio = 0.8;              // of the cells of a wall that were seen ...
  double min_open_m2 = 0.5;                 // ... and so much of one face: then it is missing, ...
  double min_length_ratio = 0.3;            // ... if that is seen over this share of its length, ...
  int min_wall_keyframes = 3;               // ... and from so many keyframes. Nor may it
  double max_offset_m = 0.6;                // stand so far off,
  double max_yaw_rad = 0.5236;              // and turned so far, as walls are built
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

struct FacePresence {
  SurfaceId surface;
  double open_m2 = 0, closed_m2 = 0;  // seen through, and seen to stop what is seen
  double lines = 0;                   // that passed
};

struct WallPresence {
  bool missing = false;
  std::vector<FacePresence> faces;  // straight ones that have cells to judge, by surface id
};

// One per plan wall. A wall is missing if what was seen passes its place, and every place where it may stand displaced. `estimate` says
// where the map lies and which walls are known to stand: what is seen on those is not in front of any other. No wall is missing in a map of
// a planar laser. O(keyframe points * walls passed), and 117 times that for points seen near walls that pass for missing. Deterministic.
[[nodiscard]] std::vector<WallPresence> JudgePresence(const SGraph& map, const AGraph& plan, const JointResult& estimate,
                                                      const PresenceOptions& options = {});

}  // namespace plumb::runtime
