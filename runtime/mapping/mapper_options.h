// Options of the mapper and its parts.
#pragma once

#include <string>

#include "runtime/mapping/spatial_loops.h"

namespace plumb::runtime {

struct MapperOptions {
  double keyframe_distance_m = 0.5;      // a new keyframe after this far, ...
  double keyframe_rotation_rad = 0.1745; // ... this much turning, ...
  double keyframe_interval_s = 2.0;      // ... or this long
  double keyframe_voxel_m = 0.05;        // points of a keyframe are thinned to one per voxel, ...
  int max_keyframe_points = 12000;       // ... and further, evenly, to this many
  // A keyframe that is no longer among the newest `recent_keyframes` is merged into an older one at most this far off (0: never), if that
  // one saw `redundant_share` of its points' surfaces as well and each of those has been seen from `well_known_views` keyframes besides.
  double redundant_distance_m = 0.5;
  double redundant_share = 0.9;
  int well_known_views = 5;
  int recent_keyframes = 20;
  int max_map_points = 4000000;          // of all keyframes (12 bytes each); beyond, those with most are thinned to half
  double min_range_m = 0.4, max_range_m = 60.0;
  double plane_sigma_m = 0.03;           // expected spread of points about a wall; the inlier band is 3 sigma
  int min_segment_points = 50;
  int min_line_points = 10;              // of a wall segment in planar scans
  double min_segment_extent_m = 0.4;
  double merge_distance_m = 0.035;  // same surface: within this at both ends of the overlap (a door leaf lies 5 cm behind its wall), ...
  double merge_angle_rad = 0.10;    // ... and this in direction (long ones less: 3 cm over the shorter's length, but at least 0.02), ...
  double merge_gap_m = 0.5;              // ... and no further apart along the wall
  SpatialLoopOptions loops;
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

}  // namespace plumb::runtime
