#include "compiler/frontends/mesh/mesh_curve_gaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "compiler/frontends/mesh/mesh_curves.h"
#include "compiler/frontends/mesh/mesh_wall_set.h"
#include "compiler/geometry/circle.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr double kOnCircle_m = 0.02;
constexpr double kMaxTurn_rad = 0.53;  // from facet to facet
constexpr double kStep_m = 0.05;       // in which a gap is looked along for what stands in it
constexpr size_t kMinJoints = 3;       // that tell of a circle

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// What one sees looking back from a free end along its chain, as far as that turns to one side.
struct ChainEnd {
  PieceEnd at;
  Vector2d place, out;            // on the middle line; the way on
  std::vector<Vector2d> corners;  // of the middle line, the closest first
  double turn_rad = 0;            // of all of them, as one comes out of the end: positive to the left
};

// From one end round the circle to the other one.
struct CurveGap {
  size_t from = 0, to = 0;  // ends
  Circle circle;
  double sweep_rad = 0, facet_rad = 0;  // signed; of one facet, positive
  [[nodiscard]] double length_m() const { return circle.radius_m * std::abs(sweep_rad); }
  [[nodiscard]] Vector2d At(const Vector2d& start, double share) const {
    const double angle = std::atan2(start.y() - circle.center.y(), start.x() - circle.center.x()) + share * sweep_rad;
    return circle.center + circle.radius_m * Vector2d(std::cos(angle), std::sin(angle));
  }
};

class CurveGapCloser {
 public:
  CurveGapCloser(const MeshOptions& options, std::vector<FaceDirection>& directions, std::vector<WallPiece>& pieces)
      : options_(options), walls_(directions), directions_(directions), pieces_(pieces) {
    walls_.pieces = pieces;
    joints_ = FindFacetJoints(directions, pieces);
    joint_of_.assign(pieces.size(), {kNone, kNone});
    for (size_t j = 0; j < joints_.size(); ++j) {
      for (const PieceEnd& e : {joints_[j].from, joints_[j].to}) joint_of_[e.piece][static_cast<size_t>(e.end)] = j;
    }
  }

  void Run() {
    FindEnds();
    std::vector<CurveGap> gaps;
    for (size_t i = 0; i < ends_.size(); ++i) {
      for (size_t j = i + 1; j < ends_.size(); ++j) {
        if (const std::optional<CurveGap> gap = GapBetween(i, j)) gaps.push_back(*gap);
      }
    }
    std::stable_sort(gaps.begin(), gaps.end(), [](const CurveGap& a, const CurveGap& b) { return a.length_m() < b.length_m(); });
    std::vector<bool> closed(ends_.size(), false);
    for (const CurveGap& gap : gaps) {
      if (closed[gap.from] || closed[gap.to]) continue;
      closed[gap.from] = closed[gap.to] = true;
      Close(gap);
    }
  }

 private:
  static constexpr size_t kNone = static_cast<size_t>(-1);

  const WallPiece& PieceOf(const ChainEnd& e) const { return walls_.pieces[e.at.piece]; }

  Vector2d MiddleAt(const PieceEnd& at) const {
    const WallPiece& p = walls_.pieces[at.piece];
    return walls_.At(p, at.end == 1 ? p.span.s1_m : p.span.s0_m, 0.5 * (p.c0_m + p.c1_m));
  }

  void FindEnds() {
    for (size_t i = 0; i < walls_.pieces.size(); ++i) {
      const WallPiece& p = walls_.pieces[i];
      for (const int end : {0, 1}) {
        const int step = end == 1 ? 1 : -1;
        if (p.sheet || joint_of_[i][static_cast<size_t>(end)] != kNone || !walls_.IsFree(p, step)) continue;
        ChainEnd out{{i, end}, MiddleAt({i, end}), step * directions_[p.direction].along, {}, 0};
        LookBack(out);
        ends_.push_back(std::move(out));
      }
    }
  }

  void LookBack(ChainEnd& end) const {
    PieceEnd far{end.at.piece, 1 - end.at.end};
    for (size_t j = JointOf(far); j != kNone; j = JointOf(far)) {
      const FacetJoint& joint = joints_[j];
      const bool along = joint.from.piece == far.piece;
      const double turn_rad = along ? -joint.turn_rad : joint.turn_rad;  // as one comes back
      if (end.turn_rad * turn_rad < 0) return;
      end.turn_rad += turn_rad;
      end.corners.push_back(0.5 * (joint.left + joint.right));
      far = along ? joint.to : joint.from;
      far.end = 1 - far.end;
    }
  }
  size_t JointOf(const PieceEnd& e) const { return joint_of_[e.piece][static_cast<size_t>(e.end)]; }

  std::optional<CurveGap> GapBetween(size_t i, size_t j) const {
    const ChainEnd &a = ends_[i], &b = ends_[j];
    const WallPiece &p = PieceOf(a), &q = PieceOf(b);
    const size_t joints = a.corners.size() + b.corners.size();
    if (a.at.piece == b.at.piece || joints < kMinJoints || a.turn_rad * b.turn_rad > 0) return std::nullopt;
    if ((a.place - b.place).norm() > options_.max_free_gap_m || p.parapet != q.parapet || !IsSameThickness(p, q)) return std::nullopt;
    std::vector<Vector2d> corners = a.corners;
    corners.insert(corners.end(), b.corners.begin(), b.corners.end());
    const std::optional<Circle> circle = FitCircle(corners);
    if (!circle) return std::nullopt;
    CurveGap gap{i, j, *circle, 0, (std::abs(a.turn_rad) + std::abs(b.turn_rad)) / static_cast<double>(joints)};
    for (const Vector2d& c : corners) {
      if (std::abs((c - circle->center).norm() - circle->radius_m) > kOnCircle_m) return std::nullopt;
    }
    if (!IsOnCircle(p, gap) || !IsOnCircle(q, gap)) return std::nullopt;
    const Vector2d u = a.place - circle->center, v = b.place - circle->center;
    const double side = Cross(u, a.out) > 0 ? 1 : -1;
    if (!GoesAlong(u, side * a.out) || !GoesAlong(v, -side * b.out)) return std::nullopt;
    double sweep_rad = side * std::atan2(Cross(u, v), u.dot(v));
    if (sweep_rad < 0) sweep_rad += 2 * std::numbers::pi;
    gap.sweep_rad = side * sweep_rad;
    // The wall is more than its doorway: little of an arc tells of no circle.
    if (sweep_rad > std::max(std::abs(a.turn_rad), std::abs(b.turn_rad))) return std::nullopt;
    return IsDoorway(gap) ? std::optional(gap) : std::nullopt;
  }

  // Ends within a facet stand inside the circle of its corners.
  bool IsOnCircle(const WallPiece& p, const CurveGap& gap) const {
    const double sagitta_m = gap.circle.radius_m * (1 - std::cos(0.5 * gap.facet_rad));
    for (const double s_m : {p.span.s0_m, p.span.s1_m}) {
      const double off_m = (walls_.At(p, s_m, 0.5 * (p.c0_m + p.c1_m)) - gap.circle.center).norm() - gap.circle.radius_m;
      if (off_m > kOnCircle_m || off_m < -kOnCircle_m - sagitta_m) return false;
    }
    return true;
  }

  // `way` is round the circle counter-clockwise at `radial` from its centre, turned by no more than a facet.
  static bool GoesAlong(const Vector2d& radial, const Vector2d& way) {
    return std::abs(std::atan2(-way.dot(radial), Cross(radial, way))) <= kMaxTurn_rad;
  }

  bool IsDoorway(const CurveGap& gap) const {
    const ChainEnd &a = ends_[gap.from], &b = ends_[gap.to];
    const WallPiece &p = PieceOf(a), &q = PieceOf(b);
    const double length_m = gap.length_m();
    if (length_m < kMinWallGap_m || length_m > options_.max_free_gap_m) return false;
    const auto is_corner = [&](const ChainEnd& e) { return walls_.IsCorner(PieceOf(e), e.at.end == 1 ? 1 : -1); };
    if (length_m > options_.max_door_gap_m && (is_corner(a) || is_corner(b))) return false;
    for (double s_m = kWallProbe_m; s_m < length_m - kWallProbe_m; s_m += kStep_m) {
      const Vector2d on = gap.At(a.place, s_m / length_m), radial = (on - gap.circle.center).normalized();
      for (const double u : {0.0, -0.4, -0.2, 0.2, 0.4}) {
        const Vector2d at = on + u * p.thickness_m() * radial;
        const auto stands = [&](const WallPiece& w) { return &w != &p && &w != &q && walls_.Holds(w, at, 0); };
        if (std::any_of(walls_.pieces.begin(), walls_.pieces.end(), stands)) return false;
      }
    }
    return true;
  }

  void Close(const CurveGap& gap) {
    const Vector2d start = ends_[gap.from].place;
    const WallPiece &p = PieceOf(ends_[gap.from]), &q = PieceOf(ends_[gap.to]);
    const int facets = std::max(1, static_cast<int>(std::lround(std::abs(gap.sweep_rad) / gap.facet_rad)));
    Vector2d from = start;
    for (int k = 1; k <= facets; ++k) {
      const Vector2d to = k == facets ? ends_[gap.to].place : gap.At(start, static_cast<double>(k) / facets);
      FaceDirection d;
      d.along = (to - from).normalized();
      d.across = {-d.along.y(), d.along.x()};
      WallPiece facet;
      facet.direction = directions_.size();
      facet.c0_m = d.C(from) - 0.5 * p.thickness_m();
      facet.c1_m = d.C(from) + 0.5 * p.thickness_m();
      facet.z0_m = std::min(p.z0_m, q.z0_m);
      facet.z1_m = std::max(p.z1_m, q.z1_m);
      facet.span = {d.S(from), d.S(to)};
      facet.group = p.group;
      facet.parapet = p.parapet;
      facet.gap = true;
      facet.closed_gaps = k == 1 ? 1 : 0;  // one doorway
      facet.voids.push_back({facet.span, facet.z0_m, facet.z1_m});
      directions_.push_back(d);
      pieces_.push_back(std::move(facet));
      from = to;
    }
  }

  const MeshOptions& options_;
  WallSet walls_;  // as they were found
  std::vector<FaceDirection>& directions_;
  std::vector<WallPiece>& pieces_;
  std::vector<FacetJoint> joints_;
  std::vector<std::array<size_t, 2>> joint_of_;  // by piece and end
  std::vector<ChainEnd> ends_;
};

}  // namespace

void CloseGapsInCurves(const MeshOptions& options, std::vector<FaceDirection>& directions, std::vector<WallPiece>& pieces) {
  CurveGapCloser(options, directions, pieces).Run();
}

}  // namespace plumb::compiler
