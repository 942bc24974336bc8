// Which faces between drawn lines are the material of walls.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "compiler/frontends/drawing/drawing.h"
#include "compiler/frontends/drawing/line_map.h"
#include "compiler/geometry/circle.h"

namespace plumb::compiler {

struct MassOptions {
  double join_m = 0.003;             // ends of lines closer than this meet
  double heal_share = 0.3;           // of a wall's thickness: ends that lie this far beside what they were to meet are slips of the pen
  double max_undershoot_m = 0.06;    // an end that stops this short of a line was to reach it
  double max_break_m = 0.2;          // two loose ends this close, with none closer, were to meet
  double max_thickness_m = 0.65;     // of a wall
  double min_thickness_m = 0.02;     // narrower faces are double strokes
  double max_pier_m = 1.5;           // the lesser side of a closed outline that stands for itself, to be a solid
  double max_loose_pier_m = 0.9;     // ... of one that is drawn by several lines
  double single_line_thickness_m = 0.1;  // of walls that are drawn as one line
  double max_double_share = 0.4;     // of the length of lines that has a partner, for the others to be walls too
  double min_single_m = 0.3;         // shorter lines without a partner are no walls
  size_t max_vertices = 2'000'000;      // where lines end, meet or cross
  [[nodiscard]] std::string Check() const;
};

// The end of a line that was led to another line, or to its end: by a slip's length moved there, farther off joined by a line.
struct Heal {
  Eigen::Vector2d from, to;
  std::optional<Eigen::Vector2d> mate;  // the other line's end, where that was led to `to` as well
  uint32_t path = 0, other = 0;         // of the drawing
  [[nodiscard]] double distance_m() const { return (mate.value_or(to) - from).norm(); }
};

struct WallMass {
  LineMap map;
  std::vector<bool> is_wall;     // by face
  std::vector<bool> is_curved;   // by edge: a step along a curve
  std::vector<uint32_t> circle_of;  // by edge: in `circles`, where it is a step along an arc; else 0xffffffff
  std::vector<Circle> circles;
  std::vector<Heal> heals;
  double typical_thickness_m = 0;  // 0: no face is a wall
  double single_m = 0;           // length of lines that have no partner
  bool single_lines = false;     // they were given a thickness
  // Drawn (there are `paths` of them), with no wall on either side.
  [[nodiscard]] bool IsSingle(uint32_t edge, size_t paths) const {
    return map.edges()[edge].source < paths && !is_wall[map.FaceOf(2 * edge)] && !is_wall[map.FaceOf(2 * edge + 1)];
  }
  // What is thicker than this must have more to show for itself to be a wall.
  [[nodiscard]] double ThickestUsual_m(const MassOptions& options) const {
    return std::min(options.max_thickness_m, std::max(0.3, 2 * typical_thickness_m));
  }
  // Half-edges with wall on the left and none on the right.
  [[nodiscard]] bool IsBoundary(uint32_t half_edge) const { return is_wall[map.FaceOf(half_edge)] && !is_wall[map.FaceOf(half_edge ^ 1u)]; }
  [[nodiscard]] bool EdgeIsBoundary(uint32_t edge) const { return IsBoundary(2 * edge) || IsBoundary(2 * edge + 1); }
};

// Loose ends are closed first: slips of the pen, the two of a wall that ends openly, those that stop short of a line, and breaks. A face is
// a wall if what lies across it from most of its boundary is no farther than walls are thick in this drawing; so is what a wall's fill
// covers, and an outline on a layer of walls that has free space around it. `paths`: those of `drawing` that may bound walls. None: too
// many crossings.
[[nodiscard]] std::optional<WallMass> FindWallMass(const Drawing& drawing, const std::vector<uint32_t>& paths, const MassOptions& options);

}  // namespace plumb::compiler
