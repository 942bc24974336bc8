// Curved walls, which a mesh has in facets: which pieces go on in one curve, and where their footprints meet.
#pragma once

#include <array>
#include <vector>

#include "compiler/frontends/mesh/mesh_walls.h"

namespace plumb::compiler {

struct WallCurves {
  // By piece. The footprint, counter-clockwise from (s0, c0); facets of a curve end where their sides meet those of the next one.
  std::vector<std::array<Eigen::Vector2d, 4>> corners;
  std::vector<size_t> first;  // of the pieces of its curve; itself for straight walls
};

// A curve is a chain of at least four facets that stand so close to an arc that nobody would call them walls of their own. O(n^2).
[[nodiscard]] WallCurves FindCurves(const std::vector<FaceDirection>& directions, const std::vector<WallPiece>& pieces);

}  // namespace plumb::compiler
