// Refines a pose on the walls: the pose that most physical walls agree on.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "runtime/matching/map_view.h"
#include "runtime/matching/plan_index.h"
#include "runtime/matching/planar_pose.h"
#include "runtime/matching/wall_pairs.h"

namespace plumb::runtime {

// What the walls say about a pose.
struct WallFit {
  PlanarPose pose;
  std::vector<WallPair> pairs;
  int consistent_planes = 0;       // planes of the plan that the map agrees with to within the wall tolerance
  double consistent_ratio = 0;     // of the map's wall length
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // of (x, y, yaw), from directions in which a majority of walls agrees
  // As above, with the other directions to within what walls deviate: the place, if not yet to the centimetre.
  Eigen::Matrix3d place_information = Eigen::Matrix3d::Zero();
  double scale_error = 0, sigma_scale = 1e3;              // how much larger the building is than the plan, 0.01 = 1 %
};

// From within about 0.4 m and 5 degrees. Tolerates walls that stand off their plan as long as most along each direction do not.
[[nodiscard]] WallFit RefineOnWalls(const PlanIndex& plan, const MapView& map, const PlanarPose& start);

// The same without moving the pose.
[[nodiscard]] WallFit AssessOnWalls(const PlanIndex& plan, const MapView& map, const PlanarPose& pose);

}  // namespace plumb::runtime
