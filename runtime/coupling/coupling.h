// Which surface of the map is which surface of the plan, given where the map lies in the plan.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// How the built wall stands to its plan, in the wall-centred form: at the planned surface's midpoint, along its normal.
struct WallDeviation {
  double offset_m = 0;   // + along the planned normal of the reference surface
  double yaw_rad = 0;    // + counter-clockwise about +z
};

struct CouplingOptions {
  double max_offset_m = 0.6;
  double max_yaw_rad = 0.35;
  double min_overlap_ratio = 0.3;   // of the shorter of the two, along the wall
  double offset_tau0_m = 0.01, offset_tau1_m = 0.20;   // mixture prior: as planned, deviated
  double yaw_tau0_rad = 0.00524, yaw_tau1_rad = 0.1396;
  double deviated_ratio = 0.2;      // prior probability that a wall deviates
  [[nodiscard]] std::string Check() const;
};

struct Match {
  uint32_t map_surface = 0;  // SGraph::surfaces
  SurfaceId plan_surface;    // AGraph::surfaces; none for floors and ceilings
  RoomId room;               // whose floor or ceiling
  double offset_m = 0, yaw_rad = 0;  // as measured under the given transform
};

// One-to-one where the plan has one candidate, many map patches to one plan surface where the map has the wall in pieces; never one patch to
// two surfaces. Ambiguous assignments are decided jointly by the smallest sum of -log p. `known`: per plan wall the deviation estimated so
// far (empty at first), so that a deviated wall keeps its patches. Deterministic.
[[nodiscard]] std::vector<Match> MatchSurfaces(const SGraph& map, const AGraph& plan, const Eigen::Isometry3d& T_plan_map,
                                               const std::vector<WallDeviation>& known, const CouplingOptions& options = {});

}  // namespace plumb::runtime
