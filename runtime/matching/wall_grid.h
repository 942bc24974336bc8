// Which walls of the map stand near a point.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/matching/map_walls.h"
#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {

// Cells of 1 m, each with the walls that come within `reach_m` of it. O(length of the walls) to make.
class WallGrid {
 public:
  WallGrid(std::span<const MapWall> walls, double reach_m);

  // Of at least all walls within the reach of `at`, their indices, ascending. O(1).
  [[nodiscard]] std::span<const uint32_t> Near(const Eigen::Vector2d& at) const;

 private:
  VoxelIndex index_;
  std::vector<std::vector<uint32_t>> cells_;
};

}  // namespace plumb::runtime
