#include "runtime/rooms/free_span.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb::runtime {
namespace {

constexpr int kDirections = 48;  // in half a turn
constexpr double kNearby_m = 0.3;
constexpr float kAsClear = 0.8F;
constexpr int kSeen_cells = 2;  // a jamb is this close to where the free space ends
constexpr double kParallelCos = 0.966;
constexpr double kBeside_m = 0.45;   // a wall's face from the narrowest place of its opening
constexpr double kAtEnd_m = 0.3;     // along the wall, from the opening's edge to where the wall was seen
constexpr double kOverlap_m = 0.15;  // of the wall and the opening: accuracy of both
constexpr double kRunsOn_m = 0.3;
constexpr double kRunsPast_m = 0.3;  // either side of the opening
constexpr double kAtCorner_m = 0.2;

Eigen::Vector2d EndTowards(const FreeSpace& space, const Eigen::Vector2d& p, const Eigen::Vector2d& along, double reach_m) {
  const FloorGrid& grid = space.grid;
  const Eigen::Vector2d step = 0.5 * along;
  Eigen::Vector2d c = (p - grid.origin) / grid.cell_m;
  for (auto left = static_cast<int>(std::ceil(2 * reach_m / grid.cell_m)); left > 0; --left) {
    const Eigen::Vector2d next = c + step;
    const int x = static_cast<int>(std::floor(next.x())), y = static_cast<int>(std::floor(next.y()));
    if (!grid.Contains(x, y) || space.cells[grid.Index(x, y)] != CellState::kFree) break;
    c = next;
  }
  return grid.origin + grid.cell_m * (c + 0.5 * step);
}

bool Seen(const FreeSpace& space, const Eigen::Vector2d& p) {
  const size_t at = space.grid.CellAt(p);
  for (int dy = -kSeen_cells; dy <= kSeen_cells; ++dy) {
    for (int dx = -kSeen_cells; dx <= kSeen_cells; ++dx) {
      const int x = space.grid.X(at) + dx, y = space.grid.Y(at) + dy;
      if (!space.grid.Contains(x, y)) continue;
      const CellState cell = space.cells[space.grid.Index(x, y)];
      if (cell == CellState::kHit || cell == CellState::kWall) return true;
    }
  }
  return false;
}

// Whether a wall across the span's direction runs past its end.
bool WallPast(const FreeSpace& space, const Eigen::Vector2d& end, const Eigen::Vector2d& across) {
  const Eigen::Vector2d passage(-across.y(), across.x());
  return std::any_of(space.walls.begin(), space.walls.end(), [&](const WallPiece& wall) {
    if (std::abs(wall.along().dot(passage)) < kParallelCos || std::abs(wall.normal().dot(end - wall.start)) > kAtCorner_m) return false;
    const double from = passage.dot(wall.start - end), to = passage.dot(wall.end - end);
    return std::min(from, to) < -kRunsPast_m && std::max(from, to) > kRunsPast_m;
  });
}

}  // namespace

FreeSpan SpanAlong(const FreeSpace& space, const Eigen::Vector2d& p, const Eigen::Vector2d& along, double reach_m) {
  return {EndTowards(space, p, -along, reach_m), EndTowards(space, p, along, reach_m)};
}

FreeSpan ShortestSpan(const FreeSpace& space, const Eigen::Vector2d& p, double reach_m) {
  FreeSpan best;
  for (int i = 0; i < kDirections; ++i) {
    const double angle_rad = std::numbers::pi * i / kDirections;
    const FreeSpan span = SpanAlong(space, p, {std::cos(angle_rad), std::sin(angle_rad)}, reach_m);
    if (i > 0 && span.width_m() >= best.width_m()) continue;
    best = span;
    reach_m = std::min(reach_m, best.width_m());  // what reaches further is longer
  }
  return best;
}

FreeSpan NarrowestSpan(const FreeSpace& space, const std::vector<float>& clearance_m, size_t cell, double reach_m) {
  const FloorGrid& grid = space.grid;
  const int reach = static_cast<int>(kNearby_m / grid.cell_m);
  FreeSpan best = ShortestSpan(space, grid.Center(cell), reach_m);
  for (int y = std::max(0, grid.Y(cell) - reach); y <= std::min(grid.height - 1, grid.Y(cell) + reach); y += 2) {
    for (int x = std::max(0, grid.X(cell) - reach); x <= std::min(grid.width - 1, grid.X(cell) + reach); x += 2) {
      const size_t i = grid.Index(x, y);
      if (clearance_m[i] < kAsClear * clearance_m[cell]) continue;
      const FreeSpan span = ShortestSpan(space, grid.Center(i), std::min(reach_m, best.width_m()));
      if (span.width_m() < best.width_m()) best = span;
    }
  }
  return best;
}

bool HasJambs(const FreeSpace& space, const FreeSpan& span) { return Seen(space, span.a) && Seen(space, span.b); }

std::vector<WallPiece> WallsBeside(const FreeSpace& space, const FreeSpan& span, bool at_b) {
  const Eigen::Vector2d end = at_b ? span.b : span.a, outwards = at_b ? span.across() : Eigen::Vector2d(-span.across());
  std::vector<WallPiece> beside;
  for (const WallPiece& wall : space.walls) {
    if (std::abs(wall.along().dot(outwards)) < kParallelCos) continue;
    if (std::abs(wall.normal().dot(end - wall.start)) > kBeside_m) continue;
    const double a = outwards.dot(wall.start - end), b = outwards.dot(wall.end - end);
    const double from = std::min(a, b), to = std::max(a, b);
    if (from >= -kOverlap_m && from <= kAtEnd_m && to >= kRunsOn_m) beside.push_back(wall);
  }
  return beside;
}

bool IsInWall(const FreeSpace& space, const FreeSpan& span) {
  const bool at_a = !WallsBeside(space, span, false).empty(), at_b = !WallsBeside(space, span, true).empty();
  if (at_a && at_b) return true;
  return (at_a && WallPast(space, span.b, span.across())) || (at_b && WallPast(space, span.a, span.across()));
}

}  // namespace plumb::runtime
