#include "compiler/frontends/drawing/open_outlines.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {
namespace {

constexpr double kParallel = 0.9995;  // the two sides of a wall: 1.8 degrees
constexpr double kOff_m = 1e-4;

class OpenOutlineFinder {
 public:
  OpenOutlineFinder(const Drawing& drawing, const WallMass& mass, const MassOptions& options)
      : drawing_(drawing), mass_(mass), map_(mass.map), options_(options), group_of_vertex_(map_.vertices().size()) {
    std::iota(group_of_vertex_.begin(), group_of_vertex_.end(), 0u);
  }

  std::vector<OpenOutline> Run() {
    std::vector<uint32_t> sides;
    for (uint32_t e = 0; e < map_.edges().size(); ++e) {
      if (!IsOpen(e)) continue;
      Join(map_.edges()[e].a, map_.edges()[e].b);
      const std::optional<uint32_t> partner = PartnerOf(e);
      if (!partner) continue;
      Join(map_.edges()[e].a, map_.edges()[*partner].a);
      sides.push_back(e);
    }
    std::map<uint32_t, std::vector<uint32_t>> groups;
    for (const uint32_t e : sides) groups[Root(map_.edges()[e].a)].push_back(e);
    std::vector<OpenOutline> out;
    for (const auto& [root, edges] : groups) {
      OpenOutline outline = Describe(edges);
      if (outline.length_m >= 2 * options_.min_single_m) out.push_back(outline);
    }
    std::stable_sort(out.begin(), out.end(), [](const OpenOutline& a, const OpenOutline& b) { return a.length_m > b.length_m; });
    return out;
  }

 private:
  double LengthOf(uint32_t e) const { return (map_.ToPoint(2 * e) - map_.FromPoint(2 * e)).norm(); }

  // A line of walls with free space on both sides.
  bool IsOpen(uint32_t e) const {
    return mass_.IsSingle(e, drawing_.paths.size()) && drawing_.paths[map_.edges()[e].source].role == LineRole::kWall;
  }

  std::optional<uint32_t> PartnerOf(uint32_t e) const {
    const Eigen::Vector2d d = map_.ToPoint(2 * e) - map_.FromPoint(2 * e), n = Perp(d).normalized();
    const double thickest_m = mass_.ThickestUsual_m(options_);
    if (d.norm() < options_.min_thickness_m) return std::nullopt;
    for (const Eigen::Vector2d& side : {n, Eigen::Vector2d(-n)}) {
      const auto hit = map_.Cast(map_.FromPoint(2 * e) + 0.5 * d + kOff_m * side, side, thickest_m, [&](uint32_t k) { return k != e; });
      if (!hit || hit->t_m < options_.min_thickness_m || !IsOpen(hit->edge)) continue;
      const Eigen::Vector2d other = map_.ToPoint(2 * hit->edge) - map_.FromPoint(2 * hit->edge);
      if (std::abs(other.dot(d)) > kParallel * other.norm() * d.norm()) return hit->edge;
    }
    return std::nullopt;
  }

  OpenOutline Describe(const std::vector<uint32_t>& edges) const {
    OpenOutline out;
    out.edges = edges;
    uint32_t longest = edges[0];
    for (const uint32_t e : edges) {
      out.length_m += LengthOf(e);
      if (LengthOf(e) > LengthOf(longest)) longest = e;
    }
    out.at = map_.FromPoint(2 * longest) + 0.5 * (map_.ToPoint(2 * longest) - map_.FromPoint(2 * longest));
    out.path = map_.edges()[longest].source;
    for (const uint32_t e : edges) {
      for (const uint32_t v : {map_.edges()[e].a, map_.edges()[e].b}) {
        if (map_.DegreeOf(v) != 1) continue;
        out.at = map_.vertices()[v];
        out.path = map_.edges()[e].source;
        return out;
      }
    }
    return out;
  }

  uint32_t Root(uint32_t v) {
    while (group_of_vertex_[v] != v) v = group_of_vertex_[v] = group_of_vertex_[group_of_vertex_[v]];
    return v;
  }
  void Join(uint32_t a, uint32_t b) {
    const auto [first, second] = std::minmax({Root(a), Root(b)});
    group_of_vertex_[second] = first;
  }

  const Drawing& drawing_;
  const WallMass& mass_;
  const LineMap& map_;
  const MassOptions& options_;
  std::vector<uint32_t> group_of_vertex_;
};

}  // namespace

std::vector<OpenOutline> FindOpenOutlines(const Drawing& drawing, const WallMass& mass, const MassOptions& options) {
  return OpenOutlineFinder(drawing, mass, options).Run();
}

}  // namespace plumb::compiler
