// Where the leaves of doors stand when they are closed. Private to openings.cc.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "compiler/frontends/drawing/openings.h"
#include "compiler/geometry/box_tree.h"

namespace plumb::compiler {

inline constexpr double kLeavesMeet_m = 0.1;  // between the tips of two leaves that close one door

// Closed or open, whichever end of its swing that is.
struct DrawnLeaf {
  Eigen::Vector2d hinge, tip;
};

class DoorLeaves {
 public:
  // `drawing` and `options` must outlive it. `symbols`: paths of `drawing` that are doors and windows.
  DoorLeaves(const Drawing& drawing, const std::vector<uint32_t>& symbols, const OpeningOptions& options);

  [[nodiscard]] const std::vector<DrawnLeaf>& all() const { return leaves_; }
  // The hinge of the other of two leaves that meet when closed; none: this one closes its door alone.
  [[nodiscard]] std::optional<Eigen::Vector2d> HingeOfMate(const DrawnLeaf& leaf) const;
  // Of one path, those that it may have when closed, from end to end: of a swing, of two of a pair as one, or along a line.
  [[nodiscard]] std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> Closed(uint32_t path) const;

 private:
  [[nodiscard]] std::vector<DrawnLeaf> OfSwings(uint32_t path) const;

  const Drawing& drawing_;
  const OpeningOptions& options_;
  std::vector<DrawnLeaf> leaves_;
  BoxTree<2> tips_;  // of leaves_
};

}  // namespace plumb::compiler
