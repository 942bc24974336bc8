// Walls one by one: straight and round runs of constant thickness in the material of all walls, and what is left beside them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/frontends/drawing/openings.h"
#include "compiler/frontends/drawing/outline.h"
#include "compiler/geometry/circle.h"
#include "schema/agraph.h"

namespace plumb::compiler {

// Between two parallel sides: `along` from start_m to end_m, its left normal from right_m to left_m. At corners that are not square one
// side is shorter than the other. Round runs go counter-clockwise, their lengths are those of the circle amid the wall, from zero_rad on.
struct WallRun {
  struct Cut {
    double right_m = 0, left_m = 0;  // one of them is 0
  };
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  double start_m = 0, end_m = 0, right_m = 0, left_m = 0;
  Cut start_cut, end_cut;  // by which a side ends before start_m or end_m
  std::optional<Circle> curve;
  double zero_rad = 0;
  uint32_t source = 0xffffffffu;  // a path that one of its sides is drawn by
  std::vector<uint32_t> openings;
  [[nodiscard]] Eigen::Vector2d At(double s, double t) const;
  [[nodiscard]] double S(const Eigen::Vector2d& p) const;
  [[nodiscard]] double T(const Eigen::Vector2d& p) const;
  [[nodiscard]] double thickness_m() const { return left_m - right_m; }
  [[nodiscard]] bool Holds(const Eigen::Vector2d& p, double slack_m) const;
  // Counter-clockwise; the whole run, or what of it is between two places along it.
  [[nodiscard]] std::vector<Eigen::Vector2d> Corners() const { return Part(start_m, end_m); }
  [[nodiscard]] std::vector<Eigen::Vector2d> Part(double from_m, double to_m) const;
  // ... no thicker than from right_m to left_m.
  [[nodiscard]] std::vector<Eigen::Vector2d> Layer(double from_m, double to_m, double right_m, double left_m) const;
  // Of its sides, the wall on the left; none of a straight run.
  [[nodiscard]] std::vector<Arc> Arcs() const;
};

struct RunOptions {
  double max_offset_m = 0.015;  // between the sides of two pieces of one wall
  double min_length_share = 0.9;  // of a piece's thickness; shorter ones are no runs
  double max_thickness_m = 0.65;
};

// Every opening is in exactly one run: a gap's wall goes on over the gap, and a gap that no wall goes on over gets a run of its own.
[[nodiscard]] std::vector<WallRun> FindWallRuns(const Outline& outline, const std::vector<DrawnOpening>& openings,
                                                const RunOptions& options);

}  // namespace plumb::compiler
