#include "compiler/frontends/drawing/wall_runs.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "compiler/frontends/drawing/plane.h"
#include "compiler/frontends/drawing/round_runs.h"

namespace plumb::compiler {
namespace {

constexpr double kFacing = 0.9995;    // cosine between the two sides of a wall: 1.8 degrees
constexpr double kSameLine = 0.9998;  // between two pieces of one
constexpr double kOff_m = 1e-3;
constexpr double kAtJamb_m = 0.05;  // from the end of a run to the gap that it ends at
constexpr double kOffSide_m = 1e-5;
constexpr double kSquare_m = 2e-3;  // corners are, if the sides end this close to each other
constexpr double kJunction = 1.6;   // a crossing wall's thickness, in those of the thickest wall

// Along the line x -> (cos, sin), the same for both directions of a wall.
Eigen::Vector2d Canonical(const Eigen::Vector2d& d) {
  return d.x() < -1e-9 || (std::abs(d.x()) <= 1e-9 && d.y() < 0) ? Eigen::Vector2d(-d) : d;
}

// The piece read in the direction of `run`: of two that lean to either side of the line where Canonical() turns round, one is read
// backwards.
WallRun AlongWith(const WallRun& run, WallRun piece) {
  if (run.along.dot(piece.along) >= 0) return piece;
  piece.along = -piece.along;
  piece.start_m = -std::exchange(piece.end_m, -piece.start_m);
  piece.right_m = -std::exchange(piece.left_m, -piece.right_m);
  return piece;
}

class RunFinder {
 public:
  RunFinder(const Outline& outline, const std::vector<DrawnOpening>& openings, const RunOptions& options)
      : outline_(outline), openings_(openings), options_(options) {}

  std::vector<WallRun> Run() {
    PairSides();
    JoinStrips();
    std::vector<WallRun> runs = MergedRuns();
    // Longer walls take the corners.
    std::stable_sort(runs.begin(), runs.end(),
                     [](const WallRun& a, const WallRun& b) { return a.end_m - a.start_m > b.end_m - b.start_m; });
    std::vector<WallRun> round = FindRoundRuns(outline_, openings_, options_);
    std::move(round.begin(), round.end(), std::back_inserter(runs));
    ExtendIntoCorners(runs);
    AssignOpenings(runs);
    return runs;
  }

 private:
  void PairSides() {
    const auto& sides = outline_.sides();
    for (uint32_t i = 0; i < sides.size(); ++i) {
      const Side& s = sides[i];
      if (s.curved || s.length_m() < kOff_m) continue;
      const Eigen::Vector2d u = s.along(), n = Perp(u);
      Eigen::AlignedBox2d box(s.a);
      box.extend(s.b);
      box.extend(s.a + options_.max_thickness_m * n);
      box.extend(s.b + options_.max_thickness_m * n);
      for (const uint32_t j : outline_.SidesIn(box)) {
        if (j > i && !sides[j].curved && sides[j].along().dot(u) < -kFacing) AddStrip(i, j);
      }
    }
  }

  void AddStrip(uint32_t i, uint32_t j) {
    const Side &s = outline_.sides()[i], &t = outline_.sides()[j];
    const Eigen::Vector2d mean = ((s.b - s.a) - (t.b - t.a)).normalized();
    const Eigen::Vector2d u = Canonical(mean);
    WallRun strip;
    strip.along = u;
    strip.start_m = std::max(std::min(u.dot(s.a), u.dot(s.b)), std::min(u.dot(t.a), u.dot(t.b)));
    strip.end_m = std::min(std::max(u.dot(s.a), u.dot(s.b)), std::max(u.dot(t.a), u.dot(t.b)));
    const double ts = Cross(u, s.middle()), tt = Cross(u, t.middle()), depth = (tt - ts) * (mean.dot(u) > 0 ? 1 : -1);
    if (depth <= kOff_m || depth > options_.max_thickness_m) return;  // t is on the left of s, where the wall is
    if (strip.end_m - strip.start_m < options_.min_length_share * depth) return;
    strip.right_m = std::min(ts, tt);
    strip.left_m = std::max(ts, tt);
    strip.source = s.source;
    const Eigen::Vector2d from = strip.At(0.5 * (strip.start_m + strip.end_m), strip.right_m + kOff_m);
    const auto across = outline_.Cast(from, Perp(u), depth + kOff_m);
    if (across && (across->side == i || across->side == j)) strips_.push_back(strip);
  }

  uint32_t Root(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  bool SameLine(const WallRun& a, const WallRun& piece) const {
    if (std::abs(a.along.dot(piece.along)) < kSameLine) return false;
    const WallRun b = AlongWith(a, piece);
    const double s = a.S(b.At(0.5 * (b.start_m + b.end_m), 0));
    const Eigen::Vector2d at = a.At(s > a.end_m ? a.end_m : a.start_m, 0);  // compared where they are near
    const double s_b = b.S(at);
    return std::abs(a.T(b.At(s_b, b.left_m)) - a.left_m) <= options_.max_offset_m &&
           std::abs(a.T(b.At(s_b, b.right_m)) - a.right_m) <= options_.max_offset_m;
  }

  void JoinStrips() {
    parent_.resize(strips_.size());
    std::iota(parent_.begin(), parent_.end(), 0u);
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const WallRun& s : strips_) boxes.push_back(BoxOf(s.Corners()));
    const BoxTree<2> tree(boxes);
    const auto join = [&](uint32_t i, uint32_t j) { parent_[std::max(Root(i), Root(j))] = std::min(Root(i), Root(j)); };
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(kJunction * options_.max_thickness_m);
    for (uint32_t i = 0; i < strips_.size(); ++i) {
      tree.ForEachIn({boxes[i].min() - reach, boxes[i].max() + reach}, [&](uint32_t j) {
        if (j > i && Root(i) != Root(j) && SameLine(strips_[i], strips_[j]) && Touches(strips_[i], strips_[j])) join(i, j);
      });
    }
    for (const DrawnOpening& o : openings_) {
      if (o.in_wall || o.curve) continue;
      const Eigen::Vector2d slack = Eigen::Vector2d::Constant(kJunction * options_.max_thickness_m);
      Eigen::AlignedBox2d at_from(o.from - slack, o.from + slack), at_to(o.to - slack, o.to + slack);
      tree.ForEachIn(at_from, [&](uint32_t i) {
        tree.ForEachIn(at_to, [&](uint32_t j) {
          if (i != j && Root(i) != Root(j) && SameLine(strips_[i], strips_[j]) && Spans(o, strips_[i], strips_[j])) join(i, j);
        });
      });
    }
  }

  // They meet, or another wall runs through between them.
  bool Touches(const WallRun& a, const WallRun& piece) const {
    const WallRun b = AlongWith(a, piece);
    const double sb0 = a.S(b.At(b.start_m, b.right_m)), sb1 = a.S(b.At(b.end_m, b.right_m));
    const double lo = std::min(a.end_m, sb1), hi = std::max(a.start_m, sb0), gap = hi - lo;
    if (gap <= kOff_m) return true;
    return gap <= kJunction * options_.max_thickness_m && outline_.InWall(a.At(0.5 * (lo + hi), 0.5 * (a.left_m + a.right_m)));
  }

  // The opening is the gap between them, or most of it where other walls stand beside it.
  bool Spans(const DrawnOpening& o, const WallRun& a, const WallRun& piece) const {
    if (std::abs(o.along().dot(a.along)) < kSameLine) return false;
    const WallRun b = AlongWith(a, piece);
    const double sb0 = a.S(b.At(b.start_m, b.right_m)), sb1 = a.S(b.At(b.end_m, b.right_m));
    const double lo = std::min(a.end_m, sb1), hi = std::max(a.start_m, sb0), t = a.T(o.middle());
    const auto [from, to] = std::minmax({a.S(o.from), a.S(o.to)});
    return t > a.right_m && t < a.left_m && IsWallFrom(a, lo, from) && IsWallFrom(a, to, hi);
  }

  bool IsWallFrom(const WallRun& run, double from_m, double to_m) const {
    if (std::abs(to_m - from_m) < kAtJamb_m) return true;
    if (to_m < from_m || to_m - from_m > kJunction * options_.max_thickness_m) return false;
    return outline_.InWall(run.At(0.5 * (from_m + to_m), 0.5 * (run.left_m + run.right_m)));
  }

  std::vector<WallRun> MergedRuns() {
    std::vector<std::vector<uint32_t>> members(strips_.size());
    for (uint32_t i = 0; i < strips_.size(); ++i) members[Root(i)].push_back(i);
    std::vector<WallRun> out;
    for (const auto& group : members) {
      if (group.empty()) continue;
      // The longest piece gives the direction; the sides are means, weighted by length.
      const auto longest = *std::max_element(group.begin(), group.end(), [&](uint32_t a, uint32_t b) { return Length(a) < Length(b); });
      WallRun run = strips_[longest];
      double total = 0, left = 0, right = 0;
      for (const uint32_t i : group) {
        const WallRun s = AlongWith(run, strips_[i]);
        const double middle = 0.5 * (s.start_m + s.end_m), weight = Length(i);
        total += weight;
        left += weight * run.T(s.At(middle, s.left_m));
        right += weight * run.T(s.At(middle, s.right_m));
        for (const double end : {s.start_m, s.end_m}) {
          const double at = run.S(s.At(end, s.right_m));
          run.start_m = std::min(run.start_m, at);
          run.end_m = std::max(run.end_m, at);
        }
        run.source = std::min(run.source, s.source);
      }
      run.left_m = left / total;
      run.right_m = right / total;
      out.push_back(run);
    }
    return out;
  }
  double Length(uint32_t i) const { return strips_[i].end_m - strips_[i].start_m; }

  // At corners one of two walls goes on to the far side of the other.
  void ExtendIntoCorners(std::vector<WallRun>& runs) const {
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const WallRun& r : runs) {
      const Eigen::Vector2d reach = Eigen::Vector2d::Constant(2 * options_.max_thickness_m);
      const Eigen::AlignedBox2d box = BoxOf(r.Corners());
      boxes.emplace_back(box.min() - reach, box.max() + reach);
    }
    const BoxTree<2> tree(std::move(boxes));
    for (size_t i = 0; i < runs.size() && !runs[i].curve; ++i) {
      for (const bool at_end : {true, false}) {
        WallRun& run = runs[i];
        const double s = at_end ? run.end_m : run.start_m, sign = at_end ? 1 : -1;
        const Eigen::Vector2d from = run.At(s + sign * kOff_m, 0.5 * (run.left_m + run.right_m));
        if (!outline_.InWall(from)) continue;
        const auto hit = outline_.Cast(from, sign * run.along, kJunction * options_.max_thickness_m);
        if (!hit) continue;
        const double reach = hit->t_m + kOff_m;
        const Eigen::Vector2d middle = run.At(s + sign * 0.5 * reach, 0.5 * (run.left_m + run.right_m));
        bool taken = false;
        const WallRun* round = nullptr;
        tree.ForEachIn(Eigen::AlignedBox2d(middle), [&](uint32_t j) {
          if (j == i || !runs[j].Holds(middle, 0)) return;
          taken = true;
          if (runs[j].curve) round = &runs[j];
        });
        if (!taken) Extend(run, at_end, [&](const Eigen::Vector2d& end) { return WallAhead(end, sign * run.along, reach); });
        if (round != nullptr) Extend(run, at_end, [&](const Eigen::Vector2d& end) { return WayTo(*round, end, sign * run.along); });
      }
    }
  }

  // As far as there is wall.
  double WallAhead(const Eigen::Vector2d& from, const Eigen::Vector2d& along, double most_m) const {
    if (!outline_.InWall(from)) return 0;
    const auto hit = outline_.Cast(from, along, kJunction * options_.max_thickness_m);
    return hit ? hit->t_m + kOffSide_m : most_m;
  }

  // As far as the face of a round wall.
  double WayTo(const WallRun& round, const Eigen::Vector2d& from, const Eigen::Vector2d& along) const {
    const Eigen::Vector2d p = from - round.curve->center;
    const double r_m = p.norm() > round.curve->radius_m ? round.curve->radius_m - round.right_m : round.curve->radius_m - round.left_m;
    const double b = p.dot(along), square = b * b - p.squaredNorm() + r_m * r_m;
    if (square < 0 || !outline_.InWall(from)) return 0;
    const double way_m = p.norm() > r_m ? -b - std::sqrt(square) : -b + std::sqrt(square);
    return way_m > 0 && way_m < kJunction * options_.max_thickness_m ? way_m : 0;
  }

  // Each side by as much as `reach_at` says from there on; both as far as each other where the corner is square.
  template <class ReachAt>
  void Extend(WallRun& run, bool at_end, const ReachAt& reach_at) const {
    double& end_m = at_end ? run.end_m : run.start_m;
    const double sign = at_end ? 1 : -1, from_m = end_m + sign * kOffSide_m;
    const double right_m = reach_at(run.At(from_m, run.right_m + kOffSide_m)), left_m = reach_at(run.At(from_m, run.left_m - kOffSide_m));
    const bool square = std::abs(right_m - left_m) < kSquare_m;
    const double most_m = std::max(right_m, left_m);
    end_m += sign * most_m;
    if (!square) (at_end ? run.end_cut : run.start_cut) = {most_m - right_m, most_m - left_m};
  }

  void AssignOpenings(std::vector<WallRun>& runs) const {
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const WallRun& r : runs) boxes.push_back(BoxOf(r.Corners()));
    const BoxTree<2> tree(std::move(boxes));
    for (uint32_t o = 0; o < openings_.size(); ++o) {
      const DrawnOpening& opening = openings_[o];
      uint32_t host = kNone;
      const auto best = [&](const Eigen::Vector2d& at, double slack_m) {
        const Eigen::Vector2d reach = Eigen::Vector2d::Constant(slack_m);
        tree.ForEachIn({at - reach, at + reach}, [&](uint32_t r) {
          if (r < host && runs[r].Holds(at, slack_m) && GoesAlong(runs[r], opening)) host = r;
        });
      };
      best(opening.middle(), kOff_m);
      const bool spanned = host != kNone;
      if (!spanned && !opening.in_wall) best(opening.from, kAtJamb_m);
      if (host == kNone) {
        runs.push_back(PieceFor(opening));
        host = static_cast<uint32_t>(runs.size() - 1);
      } else if (!spanned) {
        for (const auto& p : {opening.from, opening.to}) {
          runs[host].start_m = std::min(runs[host].start_m, runs[host].S(p));
          runs[host].end_m = std::max(runs[host].end_m, runs[host].S(p));
        }
      }
      runs[host].openings.push_back(o);
    }
  }

  static bool GoesAlong(const WallRun& run, const DrawnOpening& o) {
    if (run.curve || o.curve) return run.curve && o.curve && IsSameCurve(*run.curve, *o.curve);
    return std::abs(run.along.dot(o.along())) > kFacing;
  }

  static WallRun PieceFor(const DrawnOpening& o) {
    if (o.curve) return RoundPieceFor(o);
    WallRun run;
    run.along = o.along();
    run.start_m = run.S(o.from);
    run.end_m = run.S(o.to);
    run.left_m = run.T(o.from) + 0.5 * o.depth_m;
    run.right_m = run.T(o.from) - 0.5 * o.depth_m;
    run.source = o.path;
    return run;
  }

  const Outline& outline_;
  const std::vector<DrawnOpening>& openings_;
  const RunOptions& options_;
  std::vector<WallRun> strips_;
  std::vector<uint32_t> parent_;
};

}  // namespace

std::vector<WallRun> FindWallRuns(const Outline& outline, const std::vector<DrawnOpening>& openings, const RunOptions& options) {
  return RunFinder(outline, openings, options).Run();
}

}  // namespace plumb::compiler
