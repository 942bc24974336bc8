// How the leaves of drawn doors open: by their swings, by leaves that stand open, by panels that slide past each other.
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/frontends/drawing/openings.h"
#include "compiler/geometry/box_tree.h"
#include "compiler/geometry/door_swings.h"
#include "compiler/ir/plan_ir.h"

namespace plumb::compiler {

class OpeningLeaves {
 public:
  // `drawing` must outlive it. `symbols`: paths of it that are doors and windows.
  OpeningLeaves(const Drawing& drawing, const std::vector<uint32_t>& symbols, const OpeningOptions& options);

  // Empty where the drawing does not say.
  [[nodiscard]] std::vector<PlanLeaf> Of(const DrawnOpening& door) const;

 private:
  struct Stroke {
    Eigen::Vector2d a, b;
  };

  [[nodiscard]] std::vector<FramedLeaf> Swinging(const DrawnOpening& door) const;
  [[nodiscard]] std::vector<FramedLeaf> StandingOpen(const DrawnOpening& door) const;
  [[nodiscard]] std::vector<FramedLeaf> Sliding(const DrawnOpening& door) const;
  // In the door's frame, those that come near it; along the wall, then across it to the left.
  [[nodiscard]] std::vector<Stroke> StrokesAt(const DrawnOpening& door) const;
  [[nodiscard]] bool IsAtJamb(const DrawnOpening& door, const Eigen::Vector2d& local) const;

  const OpeningOptions& options_;
  std::vector<Arc> swings_;
  std::vector<Stroke> strokes_;
  BoxTree<2> hinges_, stroke_boxes_;  // of swings_, of strokes_
};

}  // namespace plumb::compiler
