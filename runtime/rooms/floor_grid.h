// A grid over one floor, in the map frame.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace plumb::runtime {

struct FloorGrid {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  double cell_m = 0.05;
  int width = 0, height = 0;

  [[nodiscard]] size_t size() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
  [[nodiscard]] size_t Index(int x, int y) const { return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x); }
  [[nodiscard]] int X(size_t i) const { return static_cast<int>(i % static_cast<size_t>(width)); }
  [[nodiscard]] int Y(size_t i) const { return static_cast<int>(i / static_cast<size_t>(width)); }
  [[nodiscard]] bool Contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  [[nodiscard]] Eigen::Vector2d Center(size_t i) const { return origin + cell_m * Eigen::Vector2d(X(i) + 0.5, Y(i) + 0.5); }
  // The cell that holds p, clamped to the grid.
  [[nodiscard]] size_t CellAt(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d c = (p - origin) / cell_m;
    return Index(std::clamp(static_cast<int>(std::floor(c.x())), 0, width - 1),
                 std::clamp(static_cast<int>(std::floor(c.y())), 0, height - 1));
  }
};

// Calls visit(x, y) for the cells on the way from a to b (grid coordinates, in cells), one after another, until it returns false;
// neighbours share a side, so that no way of cells that share sides or corners gets across.
template <class Visit>
void WalkCells(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Visit& visit) {
  int x = static_cast<int>(std::floor(a.x())), y = static_cast<int>(std::floor(a.y()));
  const int steps = std::abs(static_cast<int>(std::floor(b.x())) - x) + std::abs(static_cast<int>(std::floor(b.y())) - y);
  const Eigen::Vector2d d = b - a;
  const int sx = d.x() < 0 ? -1 : 1, sy = d.y() < 0 ? -1 : 1;
  const double per_x = d.x() != 0 ? std::abs(1 / d.x()) : INFINITY, per_y = d.y() != 0 ? std::abs(1 / d.y()) : INFINITY;
  double to_x = d.x() != 0 ? (d.x() < 0 ? a.x() - x : x + 1 - a.x()) * per_x : INFINITY;
  double to_y = d.y() != 0 ? (d.y() < 0 ? a.y() - y : y + 1 - a.y()) * per_y : INFINITY;
  for (int i = 0;; ++i) {
    if (!visit(x, y) || i >= steps) return;
    if (to_x < to_y) {
      x += sx;
      to_x += per_x;
    } else {
      y += sy;
      to_y += per_y;
    }
  }
}

}  // namespace plumb::runtime
