// The lines of doors and windows by place, and what they say of a gap in a wall. Private to openings.cc.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "compiler/frontends/drawing/openings.h"
#include "compiler/frontends/drawing/plane.h"
#include "compiler/geometry/box_tree.h"

namespace plumb::compiler {

// Of one gap. Paths are those of the drawing, the first of their kind; kNone: there is none.
struct SymbolEvidence {
  uint32_t door = kNone, swing = kNone, window = kNone, mixed = kNone;
  double door_span = 0, window_span = 0, mixed_span = 0;  // share of the width that lines along it take
  double mixed_line = 0;                                  // ... that one line takes
  uint32_t leaf = kNone;  // a straight line as long as the gap is wide, or half of it: a leaf that stands open
  bool sliding = false;   // panels beside each other, each about half as wide as the gap
};

class OpeningSymbols {
 public:
  // All must outlive it. `symbols`: paths of `drawing` that are doors and windows.
  OpeningSymbols(const Drawing& drawing, const std::vector<uint32_t>& symbols, const OpeningOptions& options);

  [[nodiscard]] SymbolEvidence Look(const DrawnOpening& gap) const;

  // Takes all lines in the gap, and with them the other paths of their symbols.
  void UseAllIn(const DrawnOpening& gap);
  void Use(uint32_t path);
  [[nodiscard]] bool IsUsed(uint32_t path) const;
  // Those of the same symbol, itself among them.
  [[nodiscard]] const std::vector<uint32_t>& PathsWith(uint32_t path) const { return paths_of_[GroupOf(path)]; }

 private:
  struct Stroke {
    Eigen::Vector2d a, b;
    uint32_t path;
  };

  [[nodiscard]] uint32_t GroupOf(uint32_t path) const { return group_of_[path]; }
  [[nodiscard]] std::vector<uint32_t> StrokesNear(const DrawnOpening& gap) const;

  const Drawing& drawing_;
  const OpeningOptions& options_;
  std::vector<Stroke> strokes_;
  BoxTree<2> tree_;
  std::vector<uint32_t> group_of_;               // by path: of its symbol; of itself, where it has none
  std::vector<std::vector<uint32_t>> paths_of_;  // by group
  std::vector<bool> used_;                       // by group
};

}  // namespace plumb::compiler
