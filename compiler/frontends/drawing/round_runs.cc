#include "compiler/frontends/drawing/round_runs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {
namespace {

constexpr double kPi = std::numbers::pi, kTurn_rad = 2 * kPi;
constexpr double kTouch_m = 0.01;
constexpr double kAtJamb_m = 0.08;   // from the end of a piece to the gap that it ends at: jambs may be square to the chord
constexpr double kJunction = 1.6;    // a crossing wall's thickness, in those of the thickest wall
constexpr double kSampled_m = 0.02;  // along what may be a crossing wall

// Pieces on one circle, from one angle on to the next, none over another.
using Ring = std::vector<CurvedWall>;

std::vector<Ring> GroupByCurve(const std::vector<CurvedWall>& walls) {
  std::vector<Eigen::AlignedBox2d> centers;
  for (const CurvedWall& w : walls) centers.emplace_back(w.middle.center);
  const BoxTree<2> tree(std::move(centers));
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(kSameCurve_m);
  std::vector<bool> taken(walls.size(), false);
  std::vector<Ring> out;
  for (uint32_t i = 0; i < walls.size(); ++i) {
    if (taken[i]) continue;
    std::vector<uint32_t> members;
    tree.ForEachIn({walls[i].middle.center - reach, walls[i].middle.center + reach}, [&](uint32_t j) {
      const bool as_thick = std::abs(walls[i].thickness_m - walls[j].thickness_m) < kSameCurve_m;
      if (!taken[j] && as_thick && IsSameCurve(walls[i].middle, walls[j].middle)) members.push_back(j);
    });
    std::sort(members.begin(), members.end());
    Ring& ring = out.emplace_back();
    for (const uint32_t j : members) {
      taken[j] = true;
      ring.push_back(walls[j]);
      const double turns = std::floor(walls[j].from_rad / kTurn_rad) * kTurn_rad;
      ring.back().from_rad -= turns;
      ring.back().to_rad -= turns;
    }
    std::stable_sort(ring.begin(), ring.end(), [](const CurvedWall& a, const CurvedWall& b) { return a.from_rad < b.from_rad; });
  }
  return out;
}

class RingJoiner {
 public:
  RingJoiner(const Outline& outline, const std::vector<DrawnOpening>& openings, const RunOptions& options)
      : outline_(outline), openings_(openings), options_(options) {
    std::vector<Eigen::AlignedBox2d> middles;
    for (const DrawnOpening& o : openings) middles.emplace_back(o.middle());
    tree_ = BoxTree<2>(std::move(middles));
  }

  void AddRuns(const Ring& ring, std::vector<WallRun>& out) const {
    const size_t n = ring.size();
    size_t first = 0;  // after a break
    while (first < n && GoesOn(ring[(first + n - 1) % n], ring[first])) ++first;
    if (first == n) return AddFullCircle(ring, out);
    for (size_t k = 0; k < n;) {
      CurvedWall joined = ring[(first + k) % n];
      for (++k; k < n && GoesOn(ring[(first + k - 1) % n], ring[(first + k) % n]); ++k) {
        const CurvedWall& next = ring[(first + k) % n];
        joined.to_rad = std::max(joined.to_rad, joined.from_rad + Ahead(joined.from_rad, next.from_rad) + next.to_rad - next.from_rad);
      }
      out.push_back(RunOf(joined));
    }
  }

 private:
  static double Ahead(double from_rad, double to_rad) {
    const double ahead = std::fmod(to_rad - from_rad, kTurn_rad);
    return ahead < 0 ? ahead + kTurn_rad : ahead;
  }

  static WallRun RunOf(const CurvedWall& wall) {
    WallRun run;
    run.curve = wall.middle;
    run.zero_rad = wall.from_rad;
    run.end_m = wall.length_m();
    run.right_m = -0.5 * wall.thickness_m;
    run.left_m = 0.5 * wall.thickness_m;
    run.source = wall.source;
    return run;
  }

  // They meet, an opening is between them, or another wall runs through.
  bool GoesOn(const CurvedWall& wall, const CurvedWall& next) const {
    double gap_rad = Ahead(wall.to_rad, next.from_rad);
    if (gap_rad > kTurn_rad - kTouch_m / wall.middle.radius_m) gap_rad -= kTurn_rad;
    const double gap_m = gap_rad * wall.middle.radius_m;
    if (gap_m <= kTouch_m) return true;
    return IsThrough(wall, gap_m) || IsSpanned(wall, gap_rad);
  }

  bool IsThrough(const CurvedWall& wall, double gap_m) const {
    if (gap_m > kJunction * options_.max_thickness_m) return false;
    for (double at_m = kSampled_m; at_m < gap_m; at_m += kSampled_m) {
      if (!outline_.InWall(PointAt(wall.middle, wall.to_rad + at_m / wall.middle.radius_m))) return false;
    }
    return true;
  }

  bool IsSpanned(const CurvedWall& wall, double gap_rad) const {
    const double r_m = wall.middle.radius_m, middle_rad = wall.to_rad + 0.5 * gap_rad;
    const Eigen::Vector2d at = PointAt(wall.middle, middle_rad), reach = Eigen::Vector2d::Constant(0.5 * gap_rad * r_m);
    bool spanned = false;
    tree_.ForEachIn({at - reach, at + reach}, [&](uint32_t i) {
      const DrawnOpening& o = openings_[i];
      if (!o.curve || !IsSameCurve(*o.curve, wall.middle)) return;
      const auto off_m = [&](const Eigen::Vector2d& p) { return std::abs(Nearest(AngleAt(wall.middle, p), middle_rad) - middle_rad) * r_m; };
      const auto at_end = [&](const Eigen::Vector2d& p) { return std::abs(off_m(p) - 0.5 * gap_rad * r_m) < kAtJamb_m; };
      spanned = spanned || (at_end(o.from) && at_end(o.to));
    });
    return spanned;
  }

  // In two halves, parted where no opening is.
  void AddFullCircle(const Ring& ring, std::vector<WallRun>& out) const {
    CurvedWall half = ring[0];
    for (const double at_rad : {0.0, 0.3, 0.6, 0.9, 1.2, 1.5, 1.8, 2.1, 2.4, 2.7}) {
      half.from_rad = ring[0].from_rad + at_rad;
      if (!IsInOpening(half.middle, half.from_rad) && !IsInOpening(half.middle, half.from_rad + kPi)) break;
    }
    for (int k = 0; k < 2; ++k) {
      half.to_rad = half.from_rad + kPi;
      out.push_back(RunOf(half));
      half.from_rad = half.to_rad;
    }
  }

  bool IsInOpening(const Circle& circle, double at_rad) const {
    const Eigen::Vector2d p = PointAt(circle, at_rad);
    return std::any_of(openings_.begin(), openings_.end(), [&](const DrawnOpening& o) {
      return o.curve && IsSameCurve(*o.curve, circle) && (p - o.middle()).norm() < 0.5 * o.width_m() + kAtJamb_m;
    });
  }

  const Outline& outline_;
  const std::vector<DrawnOpening>& openings_;
  const RunOptions& options_;
  BoxTree<2> tree_;  // of the openings' middles
};

}  // namespace

std::vector<WallRun> FindRoundRuns(const Outline& outline, const std::vector<DrawnOpening>& openings, const RunOptions& options) {
  std::vector<WallRun> out;
  const RingJoiner joiner(outline, openings, options);
  for (const Ring& ring : GroupByCurve(FindCurvedWalls(outline, options.max_thickness_m))) joiner.AddRuns(ring, out);
  return out;
}

WallRun RoundPieceFor(const DrawnOpening& opening) {
  WallRun run;
  run.curve = opening.curve;
  run.zero_rad = AngleAt(*run.curve, opening.middle());
  run.start_m = -(run.end_m = std::abs(run.S(opening.to)));
  run.right_m = -0.5 * opening.depth_m;
  run.left_m = 0.5 * opening.depth_m;
  run.source = opening.path;
  return run;
}

}  // namespace plumb::compiler
