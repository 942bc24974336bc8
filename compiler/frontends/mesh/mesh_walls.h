// Walls from bands: which stretches of them stand as walls, what openings they have, and which gaps between them are doors and windows.
#pragma once

#include <vector>

#include "compiler/frontends/mesh/mesh_bands.h"

namespace plumb::compiler {

inline constexpr double kWallWeld_m = 0.005;   // places along a wall closer than this are one
inline constexpr double kWallHeight_m = 2.0;   // what stands from the floor to here is a wall, whatever is above
inline constexpr double kMinWallGap_m = 0.05;  // the passes bridge smaller ones

// A void in a wall.
struct WallVoid {
  Span span;
  double z0_m = 0, z1_m = 0;
};

// An upright piece of wall: the box over [span] x [c0, c1], z0 to z1, less its voids.
struct WallPiece {
  size_t direction = 0;
  double c0_m = 0, c1_m = 0, z0_m = 0, z1_m = 0;
  Span span;
  uint32_t group = 0;
  bool sheet = false, parapet = false, column = false;
  bool gap = false;        // nothing stands in it: a facet of a doorway from floor to ceiling in a curve
  size_t closed_gaps = 0;  // gaps with nothing above or below in it
  std::vector<WallVoid> voids;
  [[nodiscard]] double thickness_m() const { return c1_m - c0_m; }
  [[nodiscard]] double length_m() const { return span.s1_m - span.s0_m; }
  [[nodiscard]] bool Contains(const FaceDirection& d, const Eigen::Vector2d& p, double slack_m) const {
    const double s = d.S(p), c = d.C(p);
    return s >= span.s0_m - slack_m && s <= span.s1_m + slack_m && c >= c0_m - slack_m && c <= c1_m + slack_m;
  }
};

struct StoreyRange {
  double floor_z_m = 0, top_z_m = 0;  // top: of what stands on the floor
};

// `breaks_m`: where the slices of the stack begin and end; one more than heights. Appends to `directions` those that only the facets of
// doorways in curves have.
[[nodiscard]] std::vector<WallPiece> FindWalls(const std::vector<Band>& bands, const std::vector<double>& breaks_m,
                                               const StoreyRange& range, const MeshOptions& options,
                                               std::vector<FaceDirection>& directions);

}  // namespace plumb::compiler
