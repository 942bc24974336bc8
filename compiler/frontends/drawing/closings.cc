#include <algorithm>
#include <cmath>

#include "compiler/frontends/drawing/loose_ends.h"
#include "compiler/frontends/drawing/plane.h"
#include "compiler/geometry/box_tree.h"

namespace plumb::compiler {
namespace {

constexpr double kParallel = 0.97, kSquare = 0.35, kBeside = 0.05;

class Closer {
 public:
  Closer(const LineMap& map, const MassOptions& options) : map_(map), options_(options), ends_(LooseEnds(map)) {}

  Closings Run() {
    ExtendToLines();
    JoinNearest(options_.max_thickness_m, [&](const LooseEnd& a, const LooseEnd& b) {
      const Eigen::Vector2d d = b.at - a.at;
      return a.out.dot(b.out) > kParallel && std::abs(d.dot(a.out)) <= kSquare * d.norm() &&
             std::min(a.length_m, b.length_m) > 0.5 * d.norm();
    });
    CapAtCorners();
    JoinNearest(options_.max_break_m, [](const LooseEnd&, const LooseEnd&) { return true; });
    return std::move(out_);
  }

 private:
  void ExtendToLines() {
    for (LooseEnd& e : ends_) {
      const double reach = std::min(options_.max_undershoot_m, 0.5 * e.length_m);
      const auto other = [&](uint32_t edge) { return map_.edges()[edge].a != e.vertex && map_.edges()[edge].b != e.vertex; };
      const std::optional<RayHit> hit = map_.Cast(e.at, e.out, reach, other);
      if (!hit) continue;
      e.used = true;
      out_.lines.emplace_back(e.at, e.at + (hit->t_m + options_.join_m) * e.out);
      out_.joined.push_back({e.at, e.at + hit->t_m * e.out, {}, SourceOf(e.edge), SourceOf(hit->edge)});
    }
  }

  // The nearest other end that `fits`, for which this one is the nearest as well.
  template <class Fits>
  void JoinNearest(double reach_m, const Fits& fits) {
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const LooseEnd& e : ends_) boxes.emplace_back(e.at);
    const BoxTree<2> tree(std::move(boxes));
    std::vector<uint32_t> nearest(ends_.size(), kNone);
    for (uint32_t i = 0; i < ends_.size(); ++i) {
      if (ends_[i].used) continue;
      const Eigen::Vector2d reach = Eigen::Vector2d::Constant(reach_m);
      double best_m = reach_m;
      tree.ForEachIn({ends_[i].at - reach, ends_[i].at + reach}, [&](uint32_t j) {
        if (j == i || ends_[j].used || !fits(ends_[i], ends_[j])) return;
        const double distance = (ends_[j].at - ends_[i].at).norm();
        if (distance < best_m || (distance == best_m && j < nearest[i])) best_m = distance, nearest[i] = j;
      });
    }
    for (uint32_t i = 0; i < ends_.size(); ++i) {
      const uint32_t j = nearest[i];
      if (j == kNone || j < i || nearest[j] != i || ends_[i].used || ends_[j].used) continue;
      ends_[i].used = ends_[j].used = true;
      out_.lines.emplace_back(ends_[i].at, ends_[j].at);
      if (Face(ends_[i], ends_[j])) out_.joined.push_back({ends_[i].at, ends_[j].at, {}, SourceOf(ends_[i].edge), SourceOf(ends_[j].edge)});
    }
  }

  // Both go on towards where the other ends, as at a break or a corner that is left out; the two lines of a wall's open end do not.
  static bool Face(const LooseEnd& a, const LooseEnd& b) {
    const Eigen::Vector2d d = (b.at - a.at).normalized();
    return a.out.dot(d) > kSquare && -b.out.dot(d) > kSquare;
  }

  uint32_t SourceOf(uint32_t edge) const { return map_.edges()[edge].source; }

  // The other line of the wall ends beside this one as well, but another wall goes on from there.
  void CapAtCorners() {
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(options_.max_thickness_m);
    for (LooseEnd& e : ends_) {
      if (e.used) continue;
      std::pair<double, uint32_t> best(options_.max_thickness_m, kNone);
      map_.VisitEdges({e.at - reach, e.at + reach}, [&](uint32_t edge) {
        for (const uint32_t h : {2 * edge, 2 * edge + 1}) {
          const Eigen::Vector2d d = map_.ToPoint(h) - e.at, line = map_.ToPoint(h) - map_.FromPoint(h);
          const bool beside = d.norm() > options_.min_thickness_m && std::abs(d.dot(e.out)) <= kBeside * d.norm();
          if (!beside || map_.To(h) == e.vertex || line.dot(e.out) < kParallel * line.norm() || GoesOn(h)) continue;
          best = std::min(best, {d.norm(), map_.To(h)});
        }
      });
      if (best.second == kNone || e.length_m < 0.5 * best.first) continue;
      e.used = true;
      out_.lines.emplace_back(e.at, map_.vertices()[best.second]);
    }
  }

  // Straight on, in another edge of the line.
  bool GoesOn(uint32_t half_edge) const {
    const Eigen::Vector2d d = (map_.ToPoint(half_edge) - map_.FromPoint(half_edge)).normalized();
    for (uint32_t h = map_.Next(half_edge); h != (half_edge ^ 1u); h = map_.Next(h ^ 1u)) {
      if ((map_.ToPoint(h) - map_.FromPoint(h)).normalized().dot(d) > kParallel) return true;
    }
    return false;
  }

  const LineMap& map_;
  const MassOptions& options_;
  std::vector<LooseEnd> ends_;
  Closings out_;
};

}  // namespace

Closings FindClosings(const LineMap& map, const MassOptions& options) {
  return Closer(map, options).Run();
}

}  // namespace plumb::compiler
