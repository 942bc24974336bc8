#include "compiler/frontends/mesh/mesh_voids.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Quad = std::array<Vector2d, 4>;

constexpr double kSameHeight_m = 0.05;

// At the ends of its piece a void ends as the piece does, askew in a curve.
Quad FootprintOf(const FaceDirection& d, const WallPiece& p, const Quad& corners, const Span& span) {
  const bool at_start = span.s0_m <= p.span.s0_m + kWallWeld_m, at_end = span.s1_m >= p.span.s1_m - kWallWeld_m;
  return {at_start ? corners[0] : d.At(span.s0_m, p.c0_m), at_end ? corners[1] : d.At(span.s1_m, p.c0_m),
          at_end ? corners[2] : d.At(span.s1_m, p.c1_m), at_start ? corners[3] : d.At(span.s0_m, p.c1_m)};
}

// The middles of both ends.
std::array<Vector2d, 2> EndsOf(const Quad& q) { return {0.5 * (q[0] + q[3]), 0.5 * (q[1] + q[2])}; }

bool GoOn(const MeshOpening& a, const MeshOpening& b) {
  if (std::abs(a.z0_m - b.z0_m) > kSameHeight_m || std::abs(a.z1_m - b.z1_m) > kSameHeight_m) return false;
  for (const Vector2d& p : EndsOf(a.footprints[0])) {
    for (const Vector2d& q : EndsOf(b.footprints[0])) {
      if ((p - q).norm() <= kWallWeld_m) return true;
    }
  }
  return false;
}

// Between those two ends that are farthest apart.
double WidthOf(const MeshOpening& opening) {
  std::vector<Vector2d> ends;
  for (const Quad& q : opening.footprints) {
    for (const Vector2d& p : EndsOf(q)) ends.push_back(p);
  }
  double out = 0;
  for (const Vector2d& p : ends) {
    for (const Vector2d& q : ends) out = std::max(out, (p - q).norm());
  }
  return out;
}

}  // namespace

std::vector<MeshOpening> JoinVoids(const std::vector<FaceDirection>& directions, const std::vector<WallPiece>& pieces,
                                   const WallCurves& curves, const std::vector<size_t>& members) {
  std::vector<MeshOpening> parts;
  for (const size_t m : members) {
    const WallPiece& p = pieces[m];
    for (const WallVoid& v : p.voids)
      parts.push_back({{FootprintOf(directions[p.direction], p, curves.corners[m], v.span)}, v.z0_m, v.z1_m, v.span.s1_m - v.span.s0_m});
  }
  if (members.size() == 1) return parts;
  std::vector<MeshOpening> out;
  std::vector<bool> taken(parts.size(), false);
  for (size_t first = 0; first < parts.size(); ++first) {
    if (taken[first]) continue;
    std::vector<size_t> chain = {first};
    taken[first] = true;
    for (size_t k = 0; k < chain.size(); ++k) {
      for (size_t i = first + 1; i < parts.size(); ++i) {
        if (taken[i] || !GoOn(parts[chain[k]], parts[i])) continue;
        taken[i] = true;
        chain.push_back(i);
      }
    }
    MeshOpening joined = parts[first];
    for (size_t k = 1; k < chain.size(); ++k) joined.footprints.push_back(parts[chain[k]].footprints[0]);
    if (chain.size() > 1) joined.width_m = WidthOf(joined);
    out.push_back(std::move(joined));
  }
  return out;
}

}  // namespace plumb::compiler
