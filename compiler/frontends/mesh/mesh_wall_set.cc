#include "compiler/frontends/mesh/mesh_wall_set.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr double kTouch_m = 0.05;

}  // namespace

const WallPiece* WallSet::PieceAt(const Vector2d& at, const WallPiece* but, double slack_m) const {
  for (const WallPiece& p : pieces) {
    if (&p != but && Holds(p, at, slack_m)) return &p;
  }
  return nullptr;
}

bool WallSet::IsInLine(const WallPiece& p, const WallPiece& q) {
  return p.direction == q.direction && std::abs(p.c0_m - q.c0_m) <= kWallLine_m && std::abs(p.c1_m - q.c1_m) <= kWallLine_m;
}

bool WallSet::IsWithin(const WallPiece& small, const WallPiece& large) const {
  if (small.z1_m > large.z1_m + kWallHeight_m) return false;
  for (const double u : {0.02, 0.25, 0.5, 0.75, 0.98}) {
    for (const double v : {0.02, 0.5, 0.98}) {
      const Vector2d p = At(small, small.span.s0_m + u * small.length_m(), small.c0_m + v * small.thickness_m());
      if (!Holds(large, p, small.sheet ? kWallProbe_m : kWallWeld_m)) return false;
    }
  }
  return true;
}

bool WallSet::IsOpenAcross(const WallPiece& p, double s_m) const {
  for (const double u : {0.5, 0.1, 0.3, 0.7, 0.9}) {
    if (PieceAt(At(p, s_m, p.c0_m + u * p.thickness_m()), &p, 0) != nullptr) return false;
  }
  return true;
}

bool WallSet::IsFree(const WallPiece& p, int step) const {
  return IsOpenAcross(p, step > 0 ? p.span.s1_m + kWallLine_m : p.span.s0_m - kWallLine_m);
}

bool WallSet::IsCorner(const WallPiece& p, int step) const {
  const double s = step > 0 ? p.span.s1_m : p.span.s0_m;
  for (const double c : {p.c0_m - kWallLine_m, p.c1_m + kWallLine_m}) {
    if (PieceAt(At(p, s - step * kWallProbe_m, c), &p, 0) != nullptr) return true;
  }
  return false;
}

WallSet::Touches WallSet::TouchesOf(const WallPiece& piece, const std::vector<WallPiece>& others) const {
  Touches out;
  const double c_m = 0.5 * (piece.c0_m + piece.c1_m);
  for (const WallPiece& p : others) {
    if (&p == &piece) continue;
    const int ends = (Holds(p, At(piece, piece.span.s0_m - kWallProbe_m, c_m), kTouch_m) ? 1 : 0) |
                     (Holds(p, At(piece, piece.span.s1_m + kWallProbe_m, c_m), kTouch_m) ? 2 : 0);
    out.any |= ends;
    if (IsInLine(p, piece)) out.in_line |= ends;
  }
  return out;
}

std::optional<WallPiece> WallSet::Turned(const WallPiece& p) const {
  const FaceDirection& d = directions_[p.direction];
  for (size_t i = 0; i < directions_.size(); ++i) {
    const FaceDirection& q = directions_[i];
    if (std::abs(q.along.dot(d.along)) > kWallWeld_m) continue;
    const Vector2d a = d.At(p.span.s0_m, p.c0_m), b = d.At(p.span.s1_m, p.c1_m);
    WallPiece out = p;
    out.direction = i;
    out.span = {std::min(q.S(a), q.S(b)), std::max(q.S(a), q.S(b))};
    out.c0_m = std::min(q.C(a), q.C(b));
    out.c1_m = std::max(q.C(a), q.C(b));
    return out;
  }
  return std::nullopt;
}

void WallSet::DropContained() {
  std::vector<size_t> order(pieces.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto area = [&](size_t i) { return pieces[i].length_m() * pieces[i].thickness_m(); };
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    if (pieces[a].sheet != pieces[b].sheet) return pieces[b].sheet;
    const bool same = std::abs(area(a) - area(b)) < 1e-6 * area(a);
    return same ? pieces[a].length_m() > pieces[b].length_m() + kWallWeld_m : area(a) > area(b);
  });
  std::vector<bool> dropped(pieces.size(), false);
  for (size_t i = 0; i < order.size(); ++i) {
    for (size_t k = 0; k < i && !dropped[order[i]]; ++k) {
      if (!dropped[order[k]] && IsWithin(pieces[order[i]], pieces[order[k]])) dropped[order[i]] = true;
    }
  }
  std::vector<WallPiece> kept;
  for (size_t i = 0; i < pieces.size(); ++i) {
    if (!dropped[i]) kept.push_back(std::move(pieces[i]));
  }
  pieces = std::move(kept);
}

}  // namespace plumb::compiler
