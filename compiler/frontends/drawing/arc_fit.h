// Arcs in lines that programs export as steps or splines along them.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "compiler/frontends/drawing/drawing.h"

namespace plumb::compiler {

struct ArcFitOptions {
  double max_turn_rad = 0.56;  // from step to step: an octagon is no circle
  size_t min_steps = 4;
  double max_step_ratio = 3;   // between the lengths of steps that follow each other
  double max_off_share = 0.04;  // of the radius: a quadratic spline for a quarter of a circle is off by half of that
  double max_off = std::numeric_limits<double>::infinity();  // ... and no more than this, in the points' unit
};

struct ArcRun {
  size_t first = 0, last = 0;  // points
  Arc arc;
};

// Least-squares circles through runs of points that turn steadily to one side; in the order of the points. Linear.
[[nodiscard]] std::vector<ArcRun> FindArcRuns(std::span<const Eigen::Vector2d> points, const ArcFitOptions& options = {});

// An open line falls into its arcs and what lies between them; a closed one stays whole and gets its arcs if they are much of it.
[[nodiscard]] std::vector<DrawnPath> SplitAtArcs(DrawnPath path, const ArcFitOptions& options = {});

// Gives walls, and lines that may be walls, the arcs that their sides step along within a centimetre, where the source has told none. The
// drawing is in metres.
void FitArcs(Drawing& drawing);

}  // namespace plumb::compiler
