// Curved walls, which a mesh has in facets: which pieces go on in one curve, and where their footprints meet.
#pragma once

#include <array>
#include <vector>

#include "compiler/frontends/mesh/mesh_walls.h"

namespace plumb::compiler {

// An end of a piece, as one comes out of it: 0 its start, 1 its end.
struct PieceEnd {
  size_t piece = 0;
  int end = 0;
};

// Two facets that go on in each other askew.
struct FacetJoint {
  PieceEnd from, to;
  Eigen::Vector2d left, right;  // where the sides meet, seen along the way out of `from`
  double turn_rad = 0, off_m = 0;
};

// Each end of a piece in one of them at most, the closest. O(n^2).
[[nodiscard]] std::vector<FacetJoint> FindFacetJoints(const std::vector<FaceDirection>& directions, const std::vector<WallPiece>& pieces);

// Whether walls are as thick as each other, as facets of one curve are.
[[nodiscard]] bool IsSameThickness(const WallPiece& p, const WallPiece& q);

struct WallCurves {
  // By piece. The footprint, counter-clockwise from (s0, c0); facets of a curve end where their sides meet those of the next one.
  std::vector<std::array<Eigen::Vector2d, 4>> corners;
  std::vector<size_t> first;  // of the pieces of its curve; itself for straight walls
};

// A curve is a chain of at least four facets that stand so close to an arc that nobody would call them walls of their own. A doorway from
// floor to ceiling makes one curve with the facets beside it, however coarse they are. O(n^2).
[[nodiscard]] WallCurves FindCurves(const std::vector<FaceDirection>& directions, const std::vector<WallPiece>& pieces);

}  // namespace plumb::compiler
