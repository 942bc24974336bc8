// Faces of the map that may be those of walls in no plan.
#pragma once

#include <Eigen/Geometry>
#include <set>
#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/deviations/panel.h"
#include "runtime/mapping/sgraph.h"
#include "schema/agraph.h"

namespace plumb::runtime {

inline constexpr double kColumn_m = 0.1;  // of MapSurface::cells

// One face of something upright, of one map surface or several on one line. The panel's normal is into the free space.
struct WallCandidate {
  Panel panel;
  double area_m2 = 0;
  std::vector<double> top_m;     // per kColumn_m of its length the highest that was seen there, in the room; -inf: nothing
  std::set<uint32_t> keyframes;
  RoomId room;
  double required_top_m = 0;     // to be as high as a wall
  size_t ended = 0, passed = 0, over = 0, mirrored = 0;  // lines of sight
};

// What matched nothing, in pieces as long as they go; the largest first. Plan frame. O(map surfaces^2).
[[nodiscard]] std::vector<WallCandidate> UnmatchedFaces(const SGraph& map, const std::vector<Match>& matches,
                                                        const Eigen::Isometry3d& T_plan_map);

// Length of it that was seen up to the height.
[[nodiscard]] double LengthAbove(const WallCandidate& candidate, double top_m);

// Leaves of it the longest part in the room that was seen without a long gap.
void TrimTo(const Room& room, WallCandidate* candidate);

}  // namespace plumb::runtime
