#include "compiler/frontends/mesh/mesh_curves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr double kMinTurn_rad = 0.01, kMaxTurn_rad = 0.53;  // from facet to facet
constexpr double kSagitta_m = 0.01;                         // of a facet: how far its middle stands off the arc
constexpr double kAtEnd_m = 0.03;                           // from a piece's end to where it meets the next one
constexpr double kThickness_m = 0.01, kThicknessShare = 0.1;
constexpr size_t kMinFacets = 4;

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

bool OverlapInHeight(const WallPiece& p, const WallPiece& q) { return std::min(p.z1_m, q.z1_m) > std::max(p.z0_m, q.z0_m); }

// Of the line at offset c along d with that at offset k along e.
Vector2d Crossing(const FaceDirection& d, double c_m, const FaceDirection& e, double k_m) {
  const double s_m = (k_m - c_m * e.C(d.across)) / e.C(d.along);
  return d.At(s_m, c_m);
}

// Out of one piece into the other, if they are of one thickness and their sides meet at these ends.
class FacetJoiner {
 public:
  FacetJoiner(const std::vector<FaceDirection>& directions, const std::vector<WallPiece>& pieces)
      : directions_(directions), pieces_(pieces) {}

  std::optional<FacetJoint> Join(const PieceEnd& from, const PieceEnd& to) const {
    const WallPiece &p = pieces_[from.piece], &q = pieces_[to.piece];
    if (p.sheet || q.sheet || p.column || q.column || p.direction == q.direction) return std::nullopt;
    if (!IsSameThickness(p, q) || !OverlapInHeight(p, q)) return std::nullopt;
    const FaceDirection &d = directions_[p.direction], &e = directions_[q.direction];
    const Vector2d out = (from.end == 1 ? 1 : -1) * d.along, in = (to.end == 0 ? 1 : -1) * e.along;
    FacetJoint joint{from, to, {}, {}, std::atan2(Cross(out, in), out.dot(in)), 0};
    if (std::abs(joint.turn_rad) > kMaxTurn_rad) return std::nullopt;
    const double left_m = from.end == 1 ? p.c1_m : p.c0_m, right_m = from.end == 1 ? p.c0_m : p.c1_m;
    if (std::abs(joint.turn_rad) >= kMinTurn_rad) {
      joint.left = Crossing(d, left_m, e, to.end == 0 ? q.c1_m : q.c0_m);
      joint.right = Crossing(d, right_m, e, to.end == 0 ? q.c0_m : q.c1_m);
    } else {
      if (!p.gap && !q.gap) return std::nullopt;  // walls in line
      const double end_m = EndOf(from);
      joint.left = d.At(end_m, left_m);
      joint.right = d.At(end_m, right_m);
    }
    const double reach_m = kAtEnd_m + p.thickness_m() * std::tan(0.5 * std::abs(joint.turn_rad));
    for (const Vector2d& corner : {joint.left, joint.right}) {
      const double off_p = std::abs(d.S(corner) - EndOf(from)), off_q = std::abs(e.S(corner) - EndOf(to));
      if (off_p > reach_m || off_q > reach_m || std::abs(e.C(corner) - 0.5 * (q.c0_m + q.c1_m)) > q.thickness_m()) return std::nullopt;
      joint.off_m += off_p + off_q;
    }
    return joint;
  }

 private:
  double EndOf(const PieceEnd& at) const { return at.end == 1 ? pieces_[at.piece].span.s1_m : pieces_[at.piece].span.s0_m; }

  const std::vector<FaceDirection>& directions_;
  const std::vector<WallPiece>& pieces_;
};

class CurveFinder {
 public:
  CurveFinder(const std::vector<FaceDirection>& directions, const std::vector<WallPiece>& pieces)
      : directions_(directions), pieces_(pieces), parent_(pieces.size()) {
    std::iota(parent_.begin(), parent_.end(), size_t{0});
  }

  WallCurves Run() {
    WallCurves out;
    for (const WallPiece& p : pieces_) {
      const FaceDirection& d = directions_[p.direction];
      out.corners.push_back({d.At(p.span.s0_m, p.c0_m), d.At(p.span.s1_m, p.c0_m), d.At(p.span.s1_m, p.c1_m), d.At(p.span.s0_m, p.c1_m)});
    }
    const std::vector<FacetJoint> joints = FindFacetJoints(directions_, pieces_);
    for (const FacetJoint& j : joints) {
      if (IsRound(j) || pieces_[j.from.piece].gap || pieces_[j.to.piece].gap) Unite(j.from.piece, j.to.piece);
    }
    FindCurved();
    for (size_t i = 0; i < pieces_.size(); ++i) out.first.push_back(IsCurved(i) ? Root(i) : i);
    std::vector<std::array<bool, 2>> met(pieces_.size(), {false, false});
    for (const FacetJoint& j : joints) {
      if (!IsCurved(j.from.piece) && !IsCurved(j.to.piece)) continue;
      Meet(j, out.corners);
      met[j.from.piece][static_cast<size_t>(j.from.end)] = met[j.to.piece][static_cast<size_t>(j.to.end)] = true;
    }
    for (size_t i = 0; i < pieces_.size(); ++i) {
      for (const int end : {0, 1}) {
        if (IsCurved(i) && !met[i][static_cast<size_t>(end)]) MeetFlank({i, end}, out.corners[i]);
      }
    }
    return out;
  }

 private:
  bool IsRound(const FacetJoint& j) const {
    const double longest_m = std::max(pieces_[j.from.piece].length_m(), pieces_[j.to.piece].length_m());
    return 0.5 * longest_m * std::tan(0.25 * std::abs(j.turn_rad)) <= kSagitta_m;
  }

  void FindCurved() {
    std::vector<size_t> facets(pieces_.size(), 0);
    for (size_t i = 0; i < pieces_.size(); ++i) facets[Root(i)] += pieces_[i].gap ? kMinFacets : 1;
    for (const size_t n : facets) curved_.push_back(n >= kMinFacets);
  }
  bool IsCurved(size_t i) const { return curved_[Root(i)]; }

  static void Meet(const FacetJoint& j, std::vector<std::array<Vector2d, 4>>& corners) {
    // Corners 0 and 3 are the start's, 1 and 2 the end's; 2 and 3 are on the left along the piece.
    std::array<Vector2d, 4>&p = corners[j.from.piece], &q = corners[j.to.piece];
    p[j.from.end == 1 ? 2 : 0] = j.left;
    p[j.from.end == 1 ? 1 : 3] = j.right;
    q[j.to.end == 0 ? 3 : 1] = j.left;
    q[j.to.end == 0 ? 0 : 2] = j.right;
  }

  // The last facet of a curve meets the wall that it ends at askew: both its sides go on to that wall's face.
  void MeetFlank(const PieceEnd& at, std::array<Vector2d, 4>& corners) const {
    const WallPiece& p = pieces_[at.piece];
    const FaceDirection& d = directions_[p.direction];
    const double end_m = at.end == 1 ? p.span.s1_m : p.span.s0_m;
    double least_m = std::numeric_limits<double>::infinity();
    for (const WallPiece& q : pieces_) {
      const FaceDirection& e = directions_[q.direction];
      const double askew_rad = std::acos(std::min(1.0, std::abs(d.along.dot(e.across))));
      if (&q == &p || askew_rad > kMaxTurn_rad || !OverlapInHeight(p, q)) continue;
      const double reach_m = kAtEnd_m + p.thickness_m() * std::tan(askew_rad);
      for (const double face_m : {q.c0_m, q.c1_m}) {
        const Vector2d low = Crossing(d, p.c0_m, e, face_m), high = Crossing(d, p.c1_m, e, face_m);
        const double off_m = std::max(std::abs(d.S(low) - end_m), std::abs(d.S(high) - end_m));
        const auto beside = [&](const Vector2d& c) { return e.S(c) < q.span.s0_m - kAtEnd_m || e.S(c) > q.span.s1_m + kAtEnd_m; };
        if (off_m > reach_m || off_m >= least_m || beside(low) || beside(high)) continue;
        least_m = off_m;
        corners[at.end == 1 ? 1 : 0] = low;
        corners[at.end == 1 ? 2 : 3] = high;
      }
    }
  }

  size_t Root(size_t i) const {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }
  void Unite(size_t i, size_t j) {
    const size_t a = Root(i), b = Root(j);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  const std::vector<FaceDirection>& directions_;
  const std::vector<WallPiece>& pieces_;
  std::vector<size_t> parent_;
  std::vector<bool> curved_;  // by root
};

}  // namespace

bool IsSameThickness(const WallPiece& p, const WallPiece& q) {
  return std::abs(p.thickness_m() - q.thickness_m()) <= kThickness_m + kThicknessShare * p.thickness_m();
}

std::vector<FacetJoint> FindFacetJoints(const std::vector<FaceDirection>& directions, const std::vector<WallPiece>& pieces) {
  const FacetJoiner joiner(directions, pieces);
  std::vector<FacetJoint> found;
  for (size_t i = 0; i < pieces.size(); ++i) {
    for (size_t j = i + 1; j < pieces.size(); ++j) {
      for (const int a : {0, 1}) {
        for (const int b : {0, 1}) {
          if (const std::optional<FacetJoint> joint = joiner.Join({i, a}, {j, b})) found.push_back(*joint);
        }
      }
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const FacetJoint& a, const FacetJoint& b) { return a.off_m < b.off_m; });
  std::vector<std::array<bool, 2>> taken(pieces.size(), {false, false});
  std::vector<FacetJoint> out;
  for (const FacetJoint& j : found) {
    bool &a = taken[j.from.piece][static_cast<size_t>(j.from.end)], &b = taken[j.to.piece][static_cast<size_t>(j.to.end)];
    if (!a && !b) out.push_back(j);
    a = b = a || b;
  }
  return out;
}

WallCurves FindCurves(const std::vector<FaceDirection>& directions, const std::vector<WallPiece>& pieces) {
  return CurveFinder(directions, pieces).Run();
}

}  // namespace plumb::compiler
