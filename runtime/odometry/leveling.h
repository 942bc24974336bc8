// Which way is up: from the floor, the ceiling and the walls around the sensor.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "runtime/odometry/surfel_map.h"

namespace plumb::runtime {

// The unit vector away from gravity in the map's frame: the direction within max_tilt_rad of `expected` that most of what is seen agrees
// with: floors and ceilings that are level by it, walls that are plumb; then made as good as the largest floor and ceiling and all walls
// together have it (runtime/METHOD.md, Leveling). None: they leave it uncertain by more than half a degree. Requires max_tilt_rad in (0,
// 0.7): beyond, a wall might be the floor. O(n^2) in surfels of floors.
[[nodiscard]] std::optional<Eigen::Vector3d> FindUp(const SurfelMap& map, const Eigen::Vector3d& expected, double max_tilt_rad);

// The rotation that turns `up` to the z axis and has no yaw.
[[nodiscard]] Eigen::Matrix3d LevelingRotation(const Eigen::Vector3d& up);

}  // namespace plumb::runtime
