#include "runtime/rooms/border_tracing.h"

#include <array>

namespace plumb::runtime {

Eigen::Vector2i StepOf(int direction) {
  constexpr std::array<std::array<int, 2>, 4> kSteps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  const auto& s = kSteps[static_cast<size_t>(direction)];
  return {s[0], s[1]};
}

Eigen::Vector2i OutsideOf(const BorderStep& step) {
  constexpr std::array<std::array<int, 2>, 4> kRight = {{{0, -1}, {0, 0}, {-1, 0}, {-1, -1}}};
  const auto& r = kRight[static_cast<size_t>(step.direction)];
  return step.from + Eigen::Vector2i(r[0], r[1]);
}

std::vector<Border> TraceBorders(const FloorGrid& grid, const std::vector<int32_t>& label, int32_t region, const Eigen::Vector2i& lo,
                                 const Eigen::Vector2i& hi) {
  const auto inside = [&](int x, int y) { return grid.Contains(x, y) && label[grid.Index(x, y)] == region; };
  const Eigen::Vector2i corners = hi - lo + Eigen::Vector2i(2, 2);
  // Which directions leave a corner, one bit each.
  std::vector<uint8_t> leaving(static_cast<size_t>(corners.x()) * static_cast<size_t>(corners.y()));
  const auto at = [&](const Eigen::Vector2i& c) -> uint8_t& {
    return leaving[static_cast<size_t>(c.y() - lo.y()) * static_cast<size_t>(corners.x()) + static_cast<size_t>(c.x() - lo.x())];
  };
  for (int y = lo.y(); y <= hi.y(); ++y) {
    for (int x = lo.x(); x <= hi.x(); ++x) {
      if (!inside(x, y)) continue;
      if (!inside(x, y - 1)) at({x, y}) |= 1;
      if (!inside(x + 1, y)) at({x + 1, y}) |= 2;
      if (!inside(x, y + 1)) at({x + 1, y + 1}) |= 4;
      if (!inside(x - 1, y)) at({x, y + 1}) |= 8;
    }
  }
  std::vector<Border> borders;
  for (int y = lo.y(); y <= hi.y() + 1; ++y) {
    for (int x = lo.x(); x <= hi.x() + 1; ++x) {
      while (at({x, y}) != 0) {
        Border border;
        Eigen::Vector2i c(x, y);
        int direction = 0;
        while (at(c) != 0) {
          // Where four ways meet at a corner, the one to the left stays with the same cell.
          int next = (direction + 1) % 4;
          while ((at(c) & (1 << next)) == 0) next = (next + 3) % 4;
          at(c) = static_cast<uint8_t>(at(c) & ~(1 << next));
          border.push_back({c, next});
          c += StepOf(next);
          direction = next;
        }
        borders.push_back(std::move(border));
      }
    }
  }
  return borders;
}

}  // namespace plumb::runtime
