// Ends of drawn lines that meet nothing. Private to wall_mass.cc.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "compiler/frontends/drawing/wall_mass.h"

namespace plumb::compiler {

struct LooseEnd {
  uint32_t vertex = 0, edge = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero(), out = Eigen::Vector2d::UnitX();  // the line's direction as it leaves
  double length_m = 0;  // of the edge
  bool used = false;
};

[[nodiscard]] std::vector<LooseEnd> LooseEnds(const LineMap& map);

// Slips of the pen: ends that lie beside what they were to meet, by no more than a share of how thick the wall is there and never more
// than max_undershoot_m. Nearest first, each end once; an end that runs over what it meets is none. The ends are to be moved, after which
// others may be near enough. What is longer than a slip is FindClosings()'s.
[[nodiscard]] std::vector<Heal> FindHeals(const LineMap& map, const MassOptions& options);

struct Closings {
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> lines;
  std::vector<Heal> joined;  // those among them that mend the drawing; a cap over a wall's open end does not
};

// Lines that the drawing leaves out where walls end openly, where a line stops short of another, and across breaks.
[[nodiscard]] Closings FindClosings(const LineMap& map, const MassOptions& options);

}  // namespace plumb::compiler
