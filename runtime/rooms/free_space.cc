#include "runtime/rooms/free_space.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "runtime/rooms/range_profile.h"
#include "runtime/rooms/wall_pieces.h"

namespace plumb::runtime {
namespace {

constexpr double kAssumedHeight_m = 0.5;  // of a sensor whose floor was not seen
constexpr double kMargin_m = 0.2;
constexpr double kBehindFace_cells = 0.75;  // walls are marked this far behind their faces: what lies before a face stays free
constexpr double kShortOfHit_cells = 1.0;   // free space ends this far before a hit
constexpr int kFreeNeighbours = 6;          // of eight: a cell that rays have missed

HeightBand BandOf(const MapFloor& floor, const RoomOptions& options) {
  const double floor_z_m = floor.floor_z_m.value_or(floor.sensor_z_m - kAssumedHeight_m);
  return {floor_z_m + options.band_low_m, floor_z_m + options.band_high_m};
}

FloorGrid GridOver(const std::vector<RangeProfile>& profiles, const RoomOptions& options) {
  Eigen::AlignedBox2d box;
  for (const RangeProfile& profile : profiles) {
    for (const RangeProfile::Ray& ray : profile.rays) box.extend(Eigen::Vector2d(profile.at + ray.step.cast<double>()));
  }
  FloorGrid grid;
  if (box.isEmpty()) return grid;
  const Eigen::Vector2d extent_m = box.sizes() + Eigen::Vector2d::Constant(2 * kMargin_m);
  grid.cell_m = options.cell_m;
  while (std::ceil(extent_m.x() / grid.cell_m) * std::ceil(extent_m.y() / grid.cell_m) > options.max_cells) grid.cell_m *= 2;
  grid.origin = box.min() - Eigen::Vector2d::Constant(kMargin_m);
  grid.width = static_cast<int>(std::ceil(extent_m.x() / grid.cell_m));
  grid.height = static_cast<int>(std::ceil(extent_m.y() / grid.cell_m));
  return grid;
}

void MarkWalls(FreeSpace& space) {
  const FloorGrid& grid = space.grid;
  for (const WallPiece& wall : space.walls) {
    const Eigen::Vector2d behind = -kBehindFace_cells * wall.normal();
    WalkCells((wall.start - grid.origin) / grid.cell_m + behind, (wall.end - grid.origin) / grid.cell_m + behind, [&](int x, int y) {
      if (grid.Contains(x, y)) space.cells[grid.Index(x, y)] = CellState::kWall;
      return true;
    });
  }
}

// Frees the cells along one ray up to a wall.
void MarkRay(const Eigen::Vector2d& at, const RangeProfile::Ray& ray, FreeSpace& space) {
  const FloorGrid& grid = space.grid;
  const Eigen::Vector2d from = (at - grid.origin) / grid.cell_m, way = ray.step.cast<double>() / grid.cell_m;
  const double length = way.norm(), free_length = length - (ray.hit ? kShortOfHit_cells : 0);
  if (free_length <= 0) return;
  const auto steps = static_cast<int>(std::max(std::abs(way.x()), std::abs(way.y())) * free_length / length) + 1;
  const Eigen::Vector2d step = way * (free_length / length) / steps;
  Eigen::Vector2d p = from;
  for (int i = 0; i <= steps; ++i, p += step) {
    CellState& cell = space.cells[grid.Index(static_cast<int>(p.x()), static_cast<int>(p.y()))];
    if (cell == CellState::kWall) return;
    cell = CellState::kFree;
  }
  if (!ray.hit) return;
  const Eigen::Vector2d end = from + way;
  CellState& cell = space.cells[grid.Index(static_cast<int>(end.x()), static_cast<int>(end.y()))];
  if (cell == CellState::kUnknown) cell = CellState::kHit;
}

// Rays fan out and miss single cells.
void FillPinholes(FreeSpace& space) {
  const FloorGrid& grid = space.grid;
  std::vector<size_t> missed;
  for (int y = 1; y + 1 < grid.height; ++y) {
    for (int x = 1; x + 1 < grid.width; ++x) {
      const size_t i = grid.Index(x, y);
      if (space.cells[i] != CellState::kUnknown && space.cells[i] != CellState::kHit) continue;
      int free = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) free += space.cells[grid.Index(x + dx, y + dy)] == CellState::kFree ? 1 : 0;
      }
      if (free >= kFreeNeighbours) missed.push_back(i);
    }
  }
  for (const size_t i : missed) space.cells[i] = CellState::kFree;
}

}  // namespace

FreeSpace FindFreeSpace(const SGraph& graph, const MapFloor& floor, const RoomOptions& options) {
  const HeightBand band = BandOf(floor, options);
  std::vector<RangeProfile> profiles(graph.keyframes.size());
  for (const uint32_t k : floor.keyframes) profiles[k] = ProfileOf(graph.keyframes[k], band, options.max_range_m);
  FreeSpace space;
  space.grid = GridOver(profiles, options);
  space.cells.assign(space.grid.size(), CellState::kUnknown);
  if (space.cells.empty()) return space;
  space.walls = FindWallPieces(graph, band, profiles);
  MarkWalls(space);
  for (const RangeProfile& profile : profiles) {
    for (const RangeProfile::Ray& ray : profile.rays) MarkRay(profile.at, ray, space);
  }
  FillPinholes(space);
  return space;
}

}  // namespace plumb::runtime
