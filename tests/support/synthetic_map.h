// Maps as mapping would make them, straight from a building's triangles: for tests that need a map but no scans.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "schema/agraph.h"

namespace plumb::test {

struct SyntheticMapOptions {
  std::vector<Eigen::Vector2d> positions;  // of the keyframes, plan frame
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();
  double sensor_height_m = 0.6;            // above z = 0
  double range_sigma_m = 0.02, max_range_m = 40;
  int azimuths = 360, rings = 16;          // rings from -15 to +15 degrees
  uint64_t seed = 1;
};

// Keyframes with noisy points, walls, floor and ceiling fitted to those points: pieces of planes of the building's triangles with at least
// 30 points and 0.4 m, split at gaps of 0.5 m.
[[nodiscard]] runtime::SGraph MakeSyntheticMap(const AGraph& as_built, const SyntheticMapOptions& options);

// Yaw in degrees, then translation.
[[nodiscard]] Eigen::Isometry3d UprightPose(double yaw_deg, double x, double y, double z);

}  // namespace plumb::test
