// How wide the free space is at a place.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "runtime/rooms/free_space.h"

namespace plumb::runtime {

struct FreeSpan {
  Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = Eigen::Vector2d::Zero();  // where the free space ends, to half a cell

  [[nodiscard]] double width_m() const { return (b - a).norm(); }
  [[nodiscard]] Eigen::Vector2d middle() const { return 0.5 * (a + b); }
  [[nodiscard]] Eigen::Vector2d across() const { return (b - a).normalized(); }
};

// Through p along a unit vector; `reach_m` is the most it looks at on either side.
[[nodiscard]] FreeSpan SpanAlong(const FreeSpace& space, const Eigen::Vector2d& p, const Eigen::Vector2d& along, double reach_m);

// The shortest of those in all directions. O(reach / cell).
[[nodiscard]] FreeSpan ShortestSpan(const FreeSpace& space, const Eigen::Vector2d& p, double reach_m);

// The shortest of those through the cells within 30 cm that have about as much clearance (per cell) as `cell`, at least: where a passage
// that the cell is in or next to is narrowest.
[[nodiscard]] FreeSpan NarrowestSpan(const FreeSpace& space, const std::vector<float>& clearance_m, size_t cell, double reach_m);

// Whether something was seen where the span ends, rather than nothing: a hit or a wall within 10 cm.
[[nodiscard]] bool HasJambs(const FreeSpace& space, const FreeSpan& span);

// The pieces of walls that run on from an end of the span in its direction, within 15 degrees and beside it by no more than a wall is
// thick; at `a`, or else at `b`.
[[nodiscard]] std::vector<WallPiece> WallsBeside(const FreeSpace& space, const FreeSpan& span, bool at_b);

// Whether the span is an opening in a wall: walls run on from both ends, or from one end while the other is a wall that runs past it, as
// where a door is next to a corner.
[[nodiscard]] bool IsInWall(const FreeSpace& space, const FreeSpan& span);

}  // namespace plumb::runtime
