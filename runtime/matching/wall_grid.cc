#include "runtime/matching/wall_grid.h"

#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr double kCellSize_m = 1.0, kPiece_m = 1.0;

}  // namespace

// A wall is taken piece by piece; each is in all cells that a square about its middle meets.
WallGrid::WallGrid(std::span<const MapWall> walls, double reach_m) {
  for (uint32_t i = 0; i < walls.size(); ++i) {
    const MapWall& wall = walls[i];
    const int pieces = std::max(1, static_cast<int>(std::ceil(wall.length_m / kPiece_m)));
    const double half_m = 0.5 * wall.length_m / pieces;
    for (int k = 0; k < pieces; ++k) {
      const Eigen::Vector2d middle = wall.start + (2 * k + 1) * half_m * wall.along;
      const Eigen::Vector2d lo = (middle.array() - half_m - reach_m) / kCellSize_m, hi = (middle.array() + half_m + reach_m) / kCellSize_m;
      for (double x = std::floor(lo.x()); x <= hi.x(); ++x) {
        for (double y = std::floor(lo.y()); y <= hi.y(); ++y) {
          const auto [cell, is_new] = index_.Insert(VoxelKey({x, y, 0}));
          if (is_new) cells_.emplace_back();
          if (cells_[cell].empty() || cells_[cell].back() != i) cells_[cell].push_back(i);
        }
      }
    }
  }
}

std::span<const uint32_t> WallGrid::Near(const Eigen::Vector2d& at) const {
  const uint32_t cell = index_.Find(VoxelKey({at.x() / kCellSize_m, at.y() / kCellSize_m, 0}));
  return cell == VoxelIndex::kNone ? std::span<const uint32_t>() : cells_[cell];
}

}  // namespace plumb::runtime
