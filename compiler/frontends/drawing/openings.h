// Doors, windows and passages in drawn walls: gaps between walls' ends, and the symbols that stand in them or over walls.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/frontends/drawing/drawing.h"
#include "compiler/frontends/drawing/outline.h"
#include "compiler/geometry/circle.h"

namespace plumb::compiler {

enum class DrawnUse : uint8_t { kPassage, kDoor, kWindow };

struct DrawnOpening {
  DrawnUse use = DrawnUse::kPassage;
  Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();  // jambs, on the middle of the wall
  double depth_m = 0;       // the wall's thickness there
  std::optional<Circle> curve;  // the middle of the wall, where that is curved: both jambs are on it
  bool in_wall = false;     // drawn over a wall that goes on; else in a gap
  uint32_t path = 0xffffffffu;  // of the symbol; none: a gap alone
  SourceLocation location;
  [[nodiscard]] double width_m() const { return (to - from).norm(); }  // of the chord, where the wall is curved
  [[nodiscard]] Eigen::Vector2d middle() const;                         // on the middle of the wall
  [[nodiscard]] Eigen::Vector2d along() const { return (to - from).normalized(); }
  // Along the wall from the opening's middle, and across it to the left: straight, or around the curve's centre.
  [[nodiscard]] Eigen::Vector2d Local(const Eigen::Vector2d& p) const;
};

struct OpeningOptions {
  double min_width_m = 0.45;
  double max_bare_gap_m = 1.6;         // between two ends of walls that face each other, without a symbol
  double max_bare_end_gap_m = 1.3;     // from an end to the side of another wall, without a symbol
  double max_swing_gap_m = 2.6;        // with a swing arc
  double max_door_gap_m = 6.0;         // with a line of a door along it
  double max_window_gap_m = 12.0;      // with a line of a window along it
  double symbol_slack_m = 0.15;        // a symbol this close to a gap belongs to it
  double min_swing_radius_m = 0.45, max_swing_radius_m = 1.4;
  double min_spanning_share = 0.6;     // of a gap's width, for a line along it to close it
  [[nodiscard]] std::string Check() const;
};

// Whether an arc is the swing of a door leaf: a sixth to a third of a turn, with the radius of one.
[[nodiscard]] bool IsSwing(const Arc& arc, const OpeningOptions& options);

// `symbols`: paths of `drawing` that are doors and windows.
[[nodiscard]] std::vector<DrawnOpening> FindOpenings(const Drawing& drawing, const std::vector<uint32_t>& symbols, const Outline& outline,
                                                     const OpeningOptions& options);

}  // namespace plumb::compiler
