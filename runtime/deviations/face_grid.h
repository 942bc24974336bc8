// The faces of planned walls in cells, to count the lines of sight that pass them or end at them.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "runtime/deviations/panel.h"
#include "runtime/deviations/wall_presence.h"
#include "runtime/optimization/joint_optimizer.h"
#include "schema/agraph.h"

namespace plumb::runtime {

struct FaceCell {
  bool solid = false;  // the plan has wall all over the cell and about it
  uint32_t passed = 0, ended = 0;
  uint32_t keyframes = 0, last_keyframe = 0xffffffffu;  // that lines passed from

  void CountPassed(uint32_t keyframe) {
    ++passed;
    if (last_keyframe != keyframe) ++keyframes;
    last_keyframe = keyframe;
  }
};

// Do the lines that met the cell say that nothing stands there?
[[nodiscard]] bool IsOpen(const FaceCell& cell, const PresenceOptions& options);

// A face of a wall with its cells. The panel's plane is the wall's middle plane; cells begin at the margin.
struct FaceGrid {
  SurfaceId surface;
  WallId wall;
  Panel panel;
  double half_m = 0;  // of the wall's thickness
  double cell_m = 0, margin_m = 0, z_low_m = 0, z_high_m = 0;
  int columns = 0, rows = 0;
  std::vector<FaceCell> cells;  // row by row

  [[nodiscard]] double MiddleOf(int column) const { return margin_m + (column + 0.5) * cell_m; }  // along the panel
  [[nodiscard]] FaceGrid Uncounted() const {
    FaceGrid out = *this;
    for (FaceCell& cell : out.cells) cell = {.solid = cell.solid};
    return out;
  }
  // The solid cell there; null if there is none.
  [[nodiscard]] FaceCell* At(double u, double z) {
    const int column = static_cast<int>(std::floor((u - margin_m) / cell_m)), row = static_cast<int>(std::floor((z - z_low_m) / cell_m));
    if (column < 0 || column >= columns || row < 0 || row >= rows) return nullptr;
    FaceCell& cell = cells[static_cast<size_t>(row * columns + column)];
    return cell.solid ? &cell : nullptr;
  }
};

// Of the plan's straight faces those that have solid cells, by surface id.
[[nodiscard]] std::vector<FaceGrid> MakeFaceGrids(const AGraph& plan, double cell_m, double margin_m);

// A wall that ends at another ends there wherever that was built: where it was built further in, so much of the wall is not there to be
// seen. No cell of that is solid any more. Of `estimate` count walls of which at least `min_observed_m2` was seen.
void LeaveOutCutEnds(const AGraph& plan, const JointResult& estimate, double min_observed_m2, std::vector<FaceGrid>& grids);

}  // namespace plumb::runtime
