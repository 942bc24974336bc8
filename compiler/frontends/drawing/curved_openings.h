// Gaps in curved walls, and symbols that are drawn over them. Private to openings.cc.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "compiler/frontends/drawing/curved_walls.h"
#include "compiler/frontends/drawing/openings.h"

namespace plumb::compiler {

struct CurvedGap {
  DrawnOpening opening;
  uint32_t far_side = 0;  // of the outline, across the gap
};

class CurvedOpenings {
 public:
  // Both must outlive it.
  CurvedOpenings(const Outline& outline, const OpeningOptions& options);

  // An end of a wall between two arcs about one centre.
  [[nodiscard]] bool IsEndOfCurve(uint32_t side) const;
  // In front of such an end, on around the centre. None: nothing is across.
  [[nodiscard]] std::optional<CurvedGap> GapBefore(uint32_t end) const;
  // In the wall that both points lie in or close by, as wide as they are apart: leaves of doors are straight.
  [[nodiscard]] std::optional<DrawnOpening> Between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  // In the wall that all points lie in or close by, as those of a window with curved panes. Jambs may be square to the chord or to the arc.
  [[nodiscard]] std::optional<DrawnOpening> Along(std::span<const Eigen::Vector2d> points) const;

 private:
  [[nodiscard]] bool IsBeside(const CurvedWall& wall, const Eigen::Vector2d& p) const;

  const Outline& outline_;
  const OpeningOptions& options_;
  std::vector<CurvedWall> walls_;
};

}  // namespace plumb::compiler
