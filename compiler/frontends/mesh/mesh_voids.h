// Openings of one wall: the voids of its pieces, joined where they go on from one facet of a curve to the next.
#pragma once

#include <array>
#include <vector>

#include "compiler/frontends/mesh/mesh_curves.h"

namespace plumb::compiler {

struct MeshOpening {
  std::vector<std::array<Eigen::Vector2d, 4>> footprints;  // one in each facet, counter-clockwise
  double z0_m = 0, z1_m = 0;
  double width_m = 0;  // from jamb to jamb, straight
};

// `members`: pieces of one wall. In the order of their voids. O(n^2) in the voids of a curve.
[[nodiscard]] std::vector<MeshOpening> JoinVoids(const std::vector<FaceDirection>& directions, const std::vector<WallPiece>& pieces,
                                                 const WallCurves& curves, const std::vector<size_t>& members);

}  // namespace plumb::compiler
