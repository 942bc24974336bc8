// Turns registered scans into the S-Graph: keyframes, planar segments, data association, merging.
#pragma once

#include <string>

#include "runtime/mapping/sgraph.h"
#include "runtime/sources/recording.h"

namespace plumb::runtime {

struct MapperOptions {
  double keyframe_distance_m = 0.5;      // a new keyframe after this far, ...
  double keyframe_rotation_rad = 0.1745; // ... this much turning, ...
  double keyframe_interval_s = 2.0;      // ... or this long
  double keyframe_voxel_m = 0.05;        // points of a keyframe are thinned to one per voxel
  double min_range_m = 0.4, max_range_m = 60.0;
  double plane_sigma_m = 0.03;           // expected spread of points about a wall; the inlier band is 3 sigma
  int min_segment_points = 50;
  double min_segment_extent_m = 0.4;
  double merge_distance_m = 0.10;        // same surface: within this at both ends of the overlap, ...
  double merge_angle_rad = 0.10;         // ... and this in direction, ...
  double merge_gap_m = 0.5;              // ... and no further apart along the wall
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

class Mapper {
 public:
  explicit Mapper(const MapperOptions& options = {});

  // Adds one deskewed scan, points in the lidar frame at its stamp. True if it closed a keyframe, i.e. the graph has grown.
  bool AddScan(const Scan& deskewed, const Eigen::Isometry3d& T_odom_lidar);

  // From odometry's frame to the map's; changes when the optimizer moves keyframes.
  [[nodiscard]] const Eigen::Isometry3d& T_map_odom() const { return T_map_odom_; }

  [[nodiscard]] const SGraph& graph() const { return graph_; }
  [[nodiscard]] SGraph& mutable_graph() { return graph_; }

  // After keyframe poses in mutable_graph() were changed: recomputes surface planes and extents, merges what now coincides,
  // and takes T_map_odom from the newest keyframe.
  void OnPosesChanged();

 private:
  MapperOptions options_;
  SGraph graph_;
  Eigen::Isometry3d T_map_odom_ = Eigen::Isometry3d::Identity();
};

}  // namespace plumb::runtime
