// The map as matching needs it: its walls as segments, its floor, and a fixed sample of its laser rays.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "runtime/matching/map_walls.h"
#include "runtime/matching/matcher.h"
#include "runtime/matching/planar_pose.h"

namespace plumb::runtime {

struct MapRay {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::UnitX();
  double range_m = 0;
  int wall = -1;  // index into MapView::walls of the wall it ended on, -1 if on none
};

// How ranges are distributed in this map, whatever the building: what a ray would show if the plan said nothing about it.
class RangeBackground {
 public:
  explicit RangeBackground(std::span<const MapRay> rays);
  [[nodiscard]] double Density(double range_m) const;  // 1/m, positive everywhere
  [[nodiscard]] double Below(double range_m) const;    // probability of a shorter range, in (0, 1]

 private:
  std::vector<double> density_, below_;
};

// Frame: the map's, shifted by center_m in x and y.
struct MapView {
  bool planar = false;                                 // as SGraph
  Eigen::Vector2d center_m = Eigen::Vector2d::Zero();  // map frame: middle of the walls, weighted by length
  std::vector<MapWall> walls;
  double wall_length_m = 0;                           // of all of them
  double wall_sigma_m = 0.02;                         // of a wall that stands as planned: SigmaOfWalls()
  std::optional<double> floor_z_m, ceiling_z_m;       // of what is level below and above the sensor, of most points
  std::vector<double> lower_floors_z_m;               // below floor_z_m, which may be a table: the floor as well
  Eigen::Vector2d start_m = Eigen::Vector2d::Zero();  // of the first keyframe's sensor, ...
  double sensor_z_m = 0, lowest_z_m = 0;              // ... its height; height of the points (1st percentile)
  std::vector<MapRay> rays;                           // every k-th is again spread over keyframes and directions
  RangeBackground background{{}};
};

// Deterministic. Linear in points, plus rays x walls.
[[nodiscard]] MapView ViewMap(const SGraph& map, const MatcherOptions& options);

// T_plan_map of a view's pose in the plan, AGraph::origin and the view's centre put back; and the pose of T_plan_map.
[[nodiscard]] Eigen::Isometry3d PoseOfMap(const PlanarPose& pose, const MapView& view, const Eigen::Vector3d& origin);
[[nodiscard]] PlanarPose PoseOfView(const Eigen::Isometry3d& T_plan_map, const MapView& view, const Eigen::Vector3d& origin);

// The view of a building `scale` times as large in x and y, about the view's middle.
[[nodiscard]] MapView Scaled(MapView view, double scale);

}  // namespace plumb::runtime
