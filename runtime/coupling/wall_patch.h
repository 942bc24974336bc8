// Upright patches of the map as plan coordinates have them, and how far a planned face explains one. Internal to coupling/.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "runtime/coupling/sight_lines.h"
#include "runtime/coupling/wall_openings.h"
#include "runtime/mapping/sgraph.h"
#include "schema/agraph.h"

namespace plumb::runtime {

inline constexpr double kOpeningMargin_m = 0.12;  // frames reach this far beyond an opening's stated size

// A wall patch of the map, in plan coordinates.
struct Patch {
  uint32_t map_surface;
  size_t num_observations;
  Eigen::Vector2d start, end;
  Eigen::Vector3d normal;
  double z_min, z_max, z_shift, area;  // z_shift: from the map's heights to the plan's
  const std::vector<Eigen::Vector2f>* cells;  // MapSurface::cells
  [[nodiscard]] double length() const { return (end - start).norm(); }
  [[nodiscard]] Eigen::Vector2d midpoint() const { return 0.5 * (start + end); }
};

// Patches that were seen well enough to tell, in the map's order.
[[nodiscard]] std::vector<Patch> WallPatches(const SGraph& map, const Eigen::Isometry3d& T_plan_map);

// Overlap of [a0, a1] and [b0, b1] as a share of the shorter.
[[nodiscard]] double OverlapRatio(double a0, double a1, double b0, double b1);

// Share of the patch that is seen where its wall has no face. `along` runs along the wall; recessed patches may be frames.
[[nodiscard]] double OpenRatio(const Patch& patch, const std::vector<WallOpening>& openings, const Eigen::Vector2d& along, bool recessed);

// Share of the patch that lies beside the face, along the wall: at any height, as many plans do not know theirs.
[[nodiscard]] double ExplainedRatio(const Patch& patch, const Surface& surface);

// Would a wall in the patch's plane stand in the way of what was seen?
[[nodiscard]] bool IsSeenThrough(const Patch& patch, const Surface& surface, const std::vector<WallOpening>& openings,
                                 const SightLines& sight);

}  // namespace plumb::runtime
