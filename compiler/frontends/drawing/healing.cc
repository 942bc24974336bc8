#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include "compiler/frontends/drawing/loose_ends.h"
#include "compiler/frontends/drawing/plane.h"
#include "schema/polygon.h"

namespace plumb::compiler {
namespace {

constexpr double kParallel = 0.97;
constexpr double kAtEnd = 1.5;  // an end that is no more than this times as far as its line is what is meant
constexpr std::array<double, 2> kProbes_m = {0.1, 1.0};  // from the end to where the wall's thickness is looked for

// What an end may be meant to meet: another loose end, or a place on a line.
struct Candidate {
  double distance_m = 0;
  uint32_t end = 0, other = kNone;  // loose ends
  uint32_t edge = 0;                // of the map, to be met
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  [[nodiscard]] auto Key() const { return std::make_tuple(distance_m, other == kNone, end, other, edge); }
};

class Healer {
 public:
  Healer(const LineMap& map, const MassOptions& options) : map_(map), options_(options), ends_(LooseEnds(map)) {}

  std::vector<Heal> Run() {
    end_at_.assign(map_.vertices().size(), kNone);
    for (uint32_t i = 0; i < ends_.size(); ++i) end_at_[ends_[i].vertex] = i;
    for (const LooseEnd& e : ends_) reach_m_.push_back(ReachOf(e));
    for (uint32_t i = 0; i < ends_.size(); ++i) AddCandidates(i);
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) { return a.Key() < b.Key(); });
    for (const Candidate& c : candidates_) Apply(c);
    return std::move(heals_);
  }

 private:
  // A share of the wall's thickness: of the distance to the parallel line beside this one, and of its own length, which is the thickness
  // where it closes a wall's end.
  double ReachOf(const LooseEnd& e) const {
    double thickness_m = options_.max_thickness_m;
    bool found = false;
    for (const double probe_m : kProbes_m) {
      const Eigen::Vector2d p = e.at - std::min(probe_m, 0.5 * e.length_m) * e.out;
      for (const Eigen::Vector2d& side : {Perp(e.out), Eigen::Vector2d(-Perp(e.out))}) {
        const std::optional<RayHit> hit = map_.Cast(p, side, thickness_m, [&](uint32_t edge) { return edge != e.edge; });
        if (!hit || hit->t_m < options_.min_thickness_m || !IsParallel(hit->edge, e.out)) continue;
        thickness_m = hit->t_m;
        found = true;
      }
    }
    if (!found) thickness_m = options_.single_line_thickness_m;
    return std::min(options_.max_undershoot_m, options_.heal_share * std::min(thickness_m, e.length_m));
  }

  bool IsParallel(uint32_t edge, const Eigen::Vector2d& along) const {
    return std::abs((map_.ToPoint(2 * edge) - map_.FromPoint(2 * edge)).normalized().dot(along)) > kParallel;
  }

  void AddCandidates(uint32_t i) {
    const LooseEnd& e = ends_[i];
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(reach_m_[i]);
    const uint32_t back = map_.edges()[e.edge].a == e.vertex ? map_.edges()[e.edge].b : map_.edges()[e.edge].a;
    map_.VisitEdges({e.at - reach, e.at + reach}, [&](uint32_t edge) {
      const auto [a, b, source] = map_.edges()[edge];
      if (edge == e.edge || a == back || b == back) return;  // what an end ran over is not what it is to meet
      const Eigen::Vector2d& from = map_.vertices()[a];
      const Eigen::Vector2d& to = map_.vertices()[b];
      const Eigen::Vector2d nearest = NearestOnSegment(e.at, from, to);
      const double distance_m = (nearest - e.at).norm();
      if (distance_m > reach_m_[i]) return;
      bool at_end = false;  // rather than the place on the line that is nearest
      for (const uint32_t vertex : {a, b}) {
        const uint32_t other = end_at_[vertex];
        if (other == kNone) continue;
        const double apart_m = (ends_[other].at - e.at).norm();
        if (apart_m > std::min(reach_m_[i], reach_m_[other])) continue;
        at_end = at_end || apart_m <= kAtEnd * distance_m;
        if (other > i) candidates_.push_back({apart_m, i, other, edge, ends_[other].at});  // of a pair the first has it
      }
      if (!at_end) candidates_.push_back({distance_m, i, kNone, edge, nearest});
    });
  }

  void Apply(const Candidate& c) {
    LooseEnd& e = ends_[c.end];
    if (e.used || (c.other != kNone && ends_[c.other].used)) return;
    // That line's end was led to this one: they meet.
    if (c.other == kNone && met_.contains({c.edge, e.edge})) return;
    e.used = true;
    met_.insert({e.edge, c.edge});
    Heal heal = c.other == kNone ? Heal{e.at, PlaceOn(c), {}} : Meet(c);
    heal.path = map_.edges()[e.edge].source;
    heal.other = map_.edges()[c.edge].source;
    heals_.push_back(std::move(heal));
  }

  // Where both go straight on to, so that neither turns, if that is no farther than either may be led; else the longer line's end.
  Heal Meet(const Candidate& c) {
    const LooseEnd &e = ends_[c.end], &o = ends_[c.other];
    ends_[c.other].used = true;
    if (std::abs(e.out.dot(o.out)) < kParallel) {
      const Eigen::Vector2d at = e.at + Cross(o.at - e.at, o.out) / Cross(e.out, o.out) * e.out;
      const double farthest_m = std::max((at - e.at).norm(), (at - o.at).norm());
      if (farthest_m <= std::min(reach_m_[c.end], reach_m_[c.other])) return {e.at, at, o.at};
    }
    return e.length_m > o.length_m ? Heal{o.at, e.at, e.at} : Heal{e.at, o.at, o.at};
  }

  // Straight on where that is no farther than it may be.
  Eigen::Vector2d PlaceOn(const Candidate& c) const {
    const LooseEnd& e = ends_[c.end];
    const std::optional<RayHit> hit = map_.Cast(e.at, e.out, reach_m_[c.end], [&](uint32_t edge) { return edge == c.edge; });
    return hit ? e.at + hit->t_m * e.out : c.at;
  }

  const LineMap& map_;
  const MassOptions& options_;
  std::vector<LooseEnd> ends_;
  std::vector<uint32_t> end_at_;  // by vertex
  std::vector<double> reach_m_;   // by end
  std::vector<Candidate> candidates_;
  std::set<std::pair<uint32_t, uint32_t>> met_;  // edges, of the end and of what it was led to
  std::vector<Heal> heals_;
};

}  // namespace

std::vector<LooseEnd> LooseEnds(const LineMap& map) {
  std::vector<LooseEnd> ends;
  for (uint32_t h = 0; h < map.num_half_edges(); ++h) {
    if (map.DegreeOf(map.To(h)) != 1) continue;
    const Eigen::Vector2d d = map.ToPoint(h) - map.FromPoint(h);
    ends.push_back({map.To(h), h / 2, map.ToPoint(h), d.normalized(), d.norm()});
  }
  return ends;
}

std::vector<Heal> FindHeals(const LineMap& map, const MassOptions& options) { return Healer(map, options).Run(); }

}  // namespace plumb::compiler
