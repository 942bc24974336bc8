// Which surface of the map is which surface of the plan, given where the map lies in the plan.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// How the built wall stands to its plan, in the wall-centred form (wall_frame.h): at the midpoint of the wall's reference surface (its
// longest straight one), along that surface's normal.
struct WallDeviation {
  double offset_m = 0;  // + along the planned normal of the reference surface
  double yaw_rad = 0;   // + counter-clockwise about +z
};

struct CouplingOptions {
  // Gate, relative to where the wall is believed to stand. Below the depth of kitchen units and wardrobes, 0.55 to 0.6 m: where they hide a
  // whole wall, their fronts must not pass for it.
  double max_offset_m = 0.5;
  // The same in maps of planar lasers, which do not see over furniture: below the depth of shelves.
  double planar_max_offset_m = 0.2;
  double max_yaw_rad = 0.35;
  // The same for walls that nothing is matched to within these gates, where lines of sight prove that they are not where planned
  // (wall_search.h). The offset is that where the wall is least off: a long one that is turned ends metres off.
  double far_offset_m = 0.65, far_yaw_rad = 0.55;
  double max_level_offset_m = 0.25;       // the same for floors and ceilings
  double max_unknown_height_m = 1.3;      // of floors, where they fit another height better: below half a storey
  double min_overlap_ratio = 0.3;         // of the shorter of the two, along the wall
  double min_height_overlap_ratio = 0.5;  // of the shorter of the two height bands
  double max_step_m = 0.15;        // patches of one side of a wall lie on one line within this; what does not is furniture or another wall
  double unmatched_cost_nats = 6;  // a patch that no plan surface explains better than this stays unmatched
  // Mixture prior, standard deviations: as planned (limits of DIN 18202 for 3 to 6 m, 16 mm, taken as three sigmas; 0.2 deg), deviated.
  double offset_tau0_m = 0.005, offset_tau1_m = 0.20;
  double yaw_tau0_rad = 0.0035, yaw_tau1_rad = 0.1396;
  double deviated_ratio = 0.2;              // prior probability that a wall deviates
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

struct Match {
  uint32_t map_surface = 0;          // SGraph::surfaces
  SurfaceId plan_surface;            // AGraph::surfaces; none for floors and ceilings
  RoomId room;                       // whose floor or ceiling; none for walls
  double offset_m = 0, yaw_rad = 0;  // as measured under the given transform, at the middle of the overlap (floors, ceilings: along +z)
  // Of MapSurface::observations, ascending: seen in the wall's openings, or of the next wall. They got into the patch because they line up
  // with it, and say nothing of the wall.
  std::vector<uint32_t> mistaken;
  // Share of the patch's length along which the plan has the face, or others in the same plane. What goes on beyond them is another thing,
  // and a patch that leans from the one to the other does not tell how the face is turned.
  double beside_ratio = 1;
  [[nodiscard]] bool IsMistaken(size_t observation) const { return std::binary_search(mistaken.begin(), mistaken.end(), observation); }
};

// One-to-one where the plan has one candidate, many map patches to one plan surface where the map has the wall in pieces, and one patch to
// the surfaces of several walls where it runs along them one after the other: each of its observations then counts for one of them.
// Ambiguous assignments are decided by the smallest sum of -log p. All patches of one side of one wall lie on one line: where they do not,
// one line is the wall and the others go to their next candidate or stay unmatched (furniture). A line that lies behind another and reaches
// higher, or has at least half its area, is the wall rather than the one in front: nothing is seen through a wall. What goes far beyond a
// face that it stands off from is not that face. A patch most of which was seen in doorways and windows of the wall is leaves, panes and
// frames, and never matched to the wall. `known`: per plan wall the deviation estimated so far (empty at first), so that a deviated wall
// keeps its patches. In the order of map surfaces. O(map surfaces * plan surfaces). Deterministic.
[[nodiscard]] std::vector<Match> MatchSurfaces(const SGraph& map, const AGraph& plan, const Eigen::Isometry3d& T_plan_map,
                                               const std::vector<WallDeviation>& known, const CouplingOptions& options = {});

}  // namespace plumb::runtime
