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

// An end of a piece, as one comes out of it: 0 its start, 1 its end.
struct PieceEnd {
  size_t piece = 0;
  int end = 0;
};

struct Joint {
  PieceEnd from, to;
  Vector2d left, right;  // where the sides meet, seen along the way out of `from`
  double turn_rad = 0, off_m = 0;
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
    const std::vector<Joint> joints = Joints();
    for (const Joint& j : joints) {
      if (IsRound(j)) Unite(j.from.piece, j.to.piece);
    }
    std::vector<size_t> facets(pieces_.size(), 0);
    for (size_t i = 0; i < pieces_.size(); ++i) ++facets[Root(i)];
    for (size_t i = 0; i < pieces_.size(); ++i) out.first.push_back(facets[Root(i)] >= kMinFacets ? Root(i) : i);
    std::vector<std::array<bool, 2>> met(pieces_.size(), {false, false});
    for (const Joint& j : joints) {
      const bool of_curve = facets[Root(j.from.piece)] >= kMinFacets || facets[Root(j.to.piece)] >= kMinFacets;
      if (!of_curve) continue;
      Meet(j, out.corners);
      met[j.from.piece][static_cast<size_t>(j.from.end)] = met[j.to.piece][static_cast<size_t>(j.to.end)] = true;
    }
    for (size_t i = 0; i < pieces_.size(); ++i) {
      for (const int end : {0, 1}) {
        if (facets[Root(i)] >= kMinFacets && !met[i][static_cast<size_t>(end)]) MeetFlank({i, end}, out.corners[i]);
      }
    }
    return out;
  }

 private:
  // Each end of a piece in one of them at most, the closest.
  std::vector<Joint> Joints() const {
    std::vector<Joint> found;
    for (size_t i = 0; i < pieces_.size(); ++i) {
      for (size_t j = i + 1; j < pieces_.size(); ++j) {
        for (const int a : {0, 1}) {
          for (const int b : {0, 1}) {
            if (const std::optional<Joint> joint = Join({i, a}, {j, b})) found.push_back(*joint);
          }
        }
      }
    }
    std::stable_sort(found.begin(), found.end(), [](const Joint& a, const Joint& b) { return a.off_m < b.off_m; });
    std::vector<std::array<bool, 2>> taken(pieces_.size(), {false, false});
    std::vector<Joint> out;
    for (const Joint& j : found) {
      bool &a = taken[j.from.piece][static_cast<size_t>(j.from.end)], &b = taken[j.to.piece][static_cast<size_t>(j.to.end)];
      if (!a && !b) out.push_back(j);
      a = b = a || b;
    }
    return out;
  }

  // Out of one piece into the other, if they are of one thickness and their sides meet at these ends.
  std::optional<Joint> Join(const PieceEnd& from, const PieceEnd& to) const {
    const WallPiece &p = pieces_[from.piece], &q = pieces_[to.piece];
    const double thickness_m = p.thickness_m();
    if (p.sheet || q.sheet || p.column || q.column || p.direction == q.direction) return std::nullopt;
    if (std::abs(thickness_m - q.thickness_m()) > kThickness_m + kThicknessShare * thickness_m) return std::nullopt;
    if (std::min(p.z1_m, q.z1_m) <= std::max(p.z0_m, q.z0_m)) return std::nullopt;
    const FaceDirection &d = directions_[p.direction], &e = directions_[q.direction];
    const Vector2d out = (from.end == 1 ? 1 : -1) * d.along, in = (to.end == 0 ? 1 : -1) * e.along;
    const double turn = std::atan2(Cross(out, in), out.dot(in));
    if (std::abs(turn) < kMinTurn_rad || std::abs(turn) > kMaxTurn_rad) return std::nullopt;
    Joint joint{from, to, {}, {}, turn, 0};
    joint.left = Crossing(d, from.end == 1 ? p.c1_m : p.c0_m, e, to.end == 0 ? q.c1_m : q.c0_m);
    joint.right = Crossing(d, from.end == 1 ? p.c0_m : p.c1_m, e, to.end == 0 ? q.c0_m : q.c1_m);
    const double reach_m = kAtEnd_m + thickness_m * std::tan(0.5 * std::abs(turn));
    for (const Vector2d& corner : {joint.left, joint.right}) {
      const double off_p = std::abs(d.S(corner) - (from.end == 1 ? p.span.s1_m : p.span.s0_m));
      const double off_q = std::abs(e.S(corner) - (to.end == 1 ? q.span.s1_m : q.span.s0_m));
      if (off_p > reach_m || off_q > reach_m) return std::nullopt;
      joint.off_m += off_p + off_q;
    }
    return joint;
  }

  // Of the line at offset c along d with that at offset k along e.
  static Vector2d Crossing(const FaceDirection& d, double c_m, const FaceDirection& e, double k_m) {
    const double s_m = (k_m - c_m * e.C(d.across)) / e.C(d.along);
    return d.At(s_m, c_m);
  }

  bool IsRound(const Joint& j) const {
    const double longest_m = std::max(pieces_[j.from.piece].length_m(), pieces_[j.to.piece].length_m());
    return 0.5 * longest_m * std::tan(0.25 * std::abs(j.turn_rad)) <= kSagitta_m;
  }

  static void Meet(const Joint& j, std::vector<std::array<Vector2d, 4>>& corners) {
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
      if (&q == &p || askew_rad > kMaxTurn_rad || std::min(p.z1_m, q.z1_m) <= std::max(p.z0_m, q.z0_m)) continue;
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
};

}  // namespace

WallCurves FindCurves(const std::vector<FaceDirection>& directions, const std::vector<WallPiece>& pieces) {
  return CurveFinder(directions, pieces).Run();
}

}  // namespace plumb::compiler
