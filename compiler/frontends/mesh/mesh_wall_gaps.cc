#include "compiler/frontends/mesh/mesh_wall_gaps.h"

#include <algorithm>
#include <numeric>

namespace plumb::compiler {
namespace {

constexpr double kStep_m = 0.05;  // in which a gap is looked along for what stands in it
constexpr double kMinDoorGap_m = 0.5;
constexpr double kMaxCavity_m = 0.35, kCavityShare = 0.8;  // between skins of one wall; of the shorter one's length

bool IsGapBetween(const WallPiece& p, const WallPiece& q, const MeshOptions& options, const WallSet& walls) {
  if (p.parapet != q.parapet || !WallSet::IsInLine(p, q)) return false;
  const double gap_m = q.span.s0_m - p.span.s1_m;
  if (gap_m < kMinWallGap_m || gap_m > options.max_free_gap_m || !walls.IsFree(p, 1) || !walls.IsFree(q, -1)) return false;
  if (gap_m > options.max_door_gap_m && (walls.IsCorner(p, 1) || walls.IsCorner(q, -1))) return false;
  for (double s = p.span.s1_m + kWallProbe_m; s < q.span.s0_m - kWallProbe_m; s += kStep_m) {
    if (!walls.IsOpenAcross(p, s)) return false;
  }
  return true;
}

// `q` goes on where the gap behind `p` ends.
void Join(const WallPiece& q, WallPiece& p) {
  p.span.s1_m = q.span.s1_m;
  p.z0_m = std::min(p.z0_m, q.z0_m);
  p.z1_m = std::max(p.z1_m, q.z1_m);
  p.voids.insert(p.voids.end(), q.voids.begin(), q.voids.end());
  p.closed_gaps += q.closed_gaps;
}

// From the end of p, or its start, to the flank of another wall; 0: none is a door's width away.
double GapToFlank(const WallPiece& p, int step, const MeshOptions& options, const WallSet& walls) {
  if (!walls.IsFree(p, step) || walls.IsCorner(p, step) || (walls.IsFree(p, -step) && !walls.IsCorner(p, -step))) return 0;
  const double end = step > 0 ? p.span.s1_m : p.span.s0_m, c = 0.5 * (p.c0_m + p.c1_m);
  for (double gap_m = kMinWallGap_m; gap_m <= options.max_door_gap_m; gap_m += kWallProbe_m) {
    if (walls.PieceAt(walls.At(p, end + step * gap_m, c), &p, 0) != nullptr) return gap_m < kMinDoorGap_m ? 0 : gap_m;
  }
  return 0;
}

// Something stands or opens in the gap: then it is no cavity but a passage or two walls.
bool IsCrossed(const WallPiece& p, const WallPiece& q, double gap_m, const WallSet& walls) {
  const double c_m = q.c0_m > p.c1_m ? p.c1_m + 0.5 * gap_m : p.c0_m - 0.5 * gap_m;
  for (const double u : {0.1, 0.5, 0.9}) {
    if (walls.PieceAt(walls.At(p, p.span.s0_m + u * p.length_m(), c_m), nullptr, 0) != nullptr) return true;
  }
  return false;
}

}  // namespace

void CloseGapsInLine(const MeshOptions& options, WallSet& walls) {
  std::vector<size_t> order(walls.pieces.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return walls.pieces[a].span.s0_m < walls.pieces[b].span.s0_m; });
  std::vector<bool> absorbed(walls.pieces.size(), false);
  for (size_t i = 0; i < order.size(); ++i) {
    if (absorbed[order[i]]) continue;
    WallPiece& p = walls.pieces[order[i]];
    for (size_t k = i + 1; k < order.size(); ++k) {
      const WallPiece& q = walls.pieces[order[k]];
      if (absorbed[order[k]] || !IsGapBetween(p, q, options, walls)) continue;
      const Span gap{p.span.s1_m, q.span.s0_m};
      p.span.s1_m = gap.s1_m;
      p.voids.push_back({gap, std::min(p.z0_m, q.z0_m), std::max(p.z1_m, q.z1_m)});
      ++p.closed_gaps;
      if (p.group != q.group) break;
      absorbed[order[k]] = true;
      Join(q, p);
    }
  }
  std::vector<WallPiece> kept;
  for (size_t i = 0; i < walls.pieces.size(); ++i) {
    if (!absorbed[i]) kept.push_back(std::move(walls.pieces[i]));
  }
  walls.pieces = std::move(kept);
}

void CloseGapsToFlanks(const MeshOptions& options, WallSet& walls) {
  for (WallPiece& p : walls.pieces) {
    if (p.length_m() < std::max(kMinDoorGap_m, 2 * p.thickness_m())) continue;
    for (const int step : {-1, 1}) {
      const double gap_m = GapToFlank(p, step, options, walls);
      if (!(gap_m > 0)) continue;
      double& end = step > 0 ? p.span.s1_m : p.span.s0_m;
      const double to = end + step * gap_m;
      p.voids.push_back({{std::min(end, to), std::max(end, to)}, p.z0_m, p.z1_m});
      end = to;
      ++p.closed_gaps;
    }
  }
}

void CloseCavities(const MeshOptions& options, WallSet& walls) {
  for (WallPiece& p : walls.pieces) {
    for (const WallPiece& q : walls.pieces) {
      if (&p == &q || p.direction != q.direction || p.sheet || q.sheet || p.length_m() > q.length_m() + kStep_m) continue;
      const double common_m = std::min(p.span.s1_m, q.span.s1_m) - std::max(p.span.s0_m, q.span.s0_m);
      if (common_m < kCavityShare * p.length_m()) continue;
      const double above_m = q.c0_m - p.c1_m, below_m = p.c0_m - q.c1_m;
      const double gap_m = std::max(above_m, below_m);
      if (gap_m <= 0 || gap_m > kMaxCavity_m || p.thickness_m() + gap_m > 2 * options.max_wall_thickness_m) continue;
      if (IsCrossed(p, q, gap_m, walls)) continue;
      (above_m > 0 ? p.c1_m : p.c0_m) = above_m > 0 ? q.c0_m : q.c1_m;
    }
  }
}

}  // namespace plumb::compiler
