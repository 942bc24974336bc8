// Which way is up: from the floor, the ceiling and the walls around a sensor that stands roughly upright.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "runtime/odometry/surfel_map.h"

namespace plumb::runtime {

// Unit vector away from gravity in the map's frame, if that lies within max_tilt_rad of the frame's z axis and is seen: the direction that
// makes the largest floor and the largest ceiling level and the walls plumb, each weighted by how well it is measured. None: they leave
// it uncertain by more than half a degree. O(n^2) in surfels of floors.
[[nodiscard]] std::optional<Eigen::Vector3d> FindUp(const SurfelMap& map, double max_tilt_rad);

// The rotation that turns `up` to the z axis and has no yaw.
[[nodiscard]] Eigen::Matrix3d LevelingRotation(const Eigen::Vector3d& up);

}  // namespace plumb::runtime
