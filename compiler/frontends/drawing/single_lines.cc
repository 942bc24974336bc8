#include "compiler/frontends/drawing/single_lines.h"

#include <cmath>
#include <utility>

#include "compiler/frontends/drawing/arc_band.h"
#include "compiler/frontends/drawing/plane.h"
#include "compiler/geometry/box_tree.h"

namespace plumb::compiler {
namespace {

constexpr uint32_t kSingle = 0xfffffffdu;  // source of the outline of a straight wall
constexpr double kMostOfArc = 0.9;

class Widener {
 public:
  Widener(const LineMap& map, const std::vector<bool>& is_single, const MassOptions& options)
      : map_(map), is_single_(is_single), options_(options), is_step_(is_single.size(), false) {}

  WidenedLines Run(const std::vector<SourcedArc>& all) {
    const std::vector<SourcedArc> arcs = SingleArcs(all);
    CollectWalls();
    for (size_t i = 0; i < straight_; ++i) AddBox(i);
    for (const SourcedArc& a : arcs) AddStrips(a);
    return std::move(out_);
  }

 private:
  MapLine LineOf(uint32_t edge) const { return {map_.FromPoint(2 * edge), map_.ToPoint(2 * edge), map_.edges()[edge].source}; }
  static bool IsStep(const SourcedArc& a, const MapLine& line) { return line.source == a.source && IsStepAlong(a.arc, line.a, line.b); }

  // Those nearly all of whose steps are single; marks these.
  std::vector<SourcedArc> SingleArcs(const std::vector<SourcedArc>& all) {
    std::vector<SourcedArc> out;
    for (const SourcedArc& a : all) {
      if (a.arc.radius_m <= options_.single_line_thickness_m) continue;
      double single_m = 0;
      std::vector<uint32_t> steps;
      map_.VisitEdges(BoxAround(a.arc), [&](uint32_t e) {
        const MapLine line = LineOf(e);
        if (!is_single_[e] || !IsStep(a, line)) return;
        steps.push_back(e);
        single_m += (line.b - line.a).norm();
      });
      if (single_m < kMostOfArc * std::abs(a.arc.sweep_rad) * a.arc.radius_m) continue;
      for (const uint32_t e : steps) is_step_[e] = true;
      out.push_back(a);
    }
    return out;
  }

  // Straight ones, then steps along arcs.
  void CollectWalls() {
    std::vector<MapLine> singles, steps;
    for (uint32_t e = 0; e < map_.edges().size(); ++e) (is_step_[e] ? steps : is_single_[e] ? singles : out_.lines).push_back(LineOf(e));
    walls_ = MergeCollinear(std::move(singles), options_.join_m);
    straight_ = walls_.size();
    walls_.insert(walls_.end(), steps.begin(), steps.end());
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const MapLine& s : walls_) boxes.emplace_back(s.a.cwiseMin(s.b), s.a.cwiseMax(s.b));
    tree_ = BoxTree<2>(std::move(boxes));
  }

  // How much longer a wall is at this end: where another one is, for all that `is_own` says.
  template <class IsOwn>
  double Longer_m(const Eigen::Vector2d& end, const IsOwn& is_own) const {
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(2 * options_.join_m);
    bool met = false;
    tree_.ForEachIn({end - reach, end + reach}, [&](uint32_t i) {
      met = met || (!is_own(i) && DistanceToLine(end, walls_[i].a, walls_[i].b) <= 2 * options_.join_m);
    });
    return met ? half_m() : 0;
  }

  void AddBox(size_t i) {
    const MapLine& s = walls_[i];
    const Eigen::Vector2d d = s.b - s.a;
    if (d.norm() < options_.min_single_m) return;
    const auto is_own = [i](uint32_t k) { return k == i; };
    const Eigen::Vector2d along = d.normalized(), side = half_m() * Perp(along);
    const Eigen::Vector2d a = s.a - Longer_m(s.a, is_own) * along, b = s.b + Longer_m(s.b, is_own) * along;
    AddOutline({a - side, b - side, b + side, a + side}, kSingle);
  }

  void AddStrips(const SourcedArc& a) {
    const auto longer_m = [&](double angle_rad) {
      const Eigen::Vector2d end = a.arc.center + a.arc.radius_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
      return Longer_m(end, [&](uint32_t k) { return IsStep(a, walls_[k]); });
    };
    const double before_m = longer_m(a.arc.start_rad), after_m = longer_m(a.arc.start_rad + a.arc.sweep_rad);
    for (ArcBand& band : BandsAlong(a.arc, half_m(), before_m, after_m)) {
      for (const Arc& side : band.sides) out_.arcs.push_back({side, a.source});
      AddOutline(std::move(band.outline), a.source);
    }
  }

  void AddOutline(std::vector<Eigen::Vector2d> ring, uint32_t source) {
    for (size_t k = 0; k < ring.size(); ++k) out_.lines.push_back({ring[k], ring[(k + 1) % ring.size()], source});
    out_.outlines.push_back(std::move(ring));
  }

  double half_m() const { return 0.5 * options_.single_line_thickness_m; }

  const LineMap& map_;
  const std::vector<bool>& is_single_;
  const MassOptions& options_;
  std::vector<bool> is_step_;   // by edge: along an arc that becomes a strip
  std::vector<MapLine> walls_;  // along their middles
  size_t straight_ = 0;
  BoxTree<2> tree_;
  WidenedLines out_;
};

}  // namespace

WidenedLines WidenSingleLines(const LineMap& map, const std::vector<bool>& is_single, const std::vector<SourcedArc>& arcs,
                              const MassOptions& options) {
  return Widener(map, is_single, options).Run(arcs);
}

}  // namespace plumb::compiler
