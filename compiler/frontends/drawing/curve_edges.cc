#include "compiler/frontends/drawing/curve_edges.h"

#include <cmath>
#include <numbers>

#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {
namespace {

constexpr double kOnArc_m = 0.01;  // ends of a step from its arc
constexpr double kAcross = 0.5;    // cosine between a step and the radius at its middle

}  // namespace

bool IsStepAlong(const Arc& arc, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const auto is_on = [&](const Eigen::Vector2d& p) { return std::abs((p - arc.center).norm() - arc.radius_m) < kOnArc_m; };
  const Eigen::Vector2d out = 0.5 * (a + b) - arc.center;
  if (!is_on(a) || !is_on(b) || std::abs(out.dot(b - a)) > kAcross * out.norm() * (b - a).norm()) return false;
  const double middle_rad = arc.start_rad + 0.5 * arc.sweep_rad, at_rad = std::atan2(out.y(), out.x());
  return std::abs(std::remainder(at_rad - middle_rad, 2 * std::numbers::pi)) <= 0.5 * std::abs(arc.sweep_rad) + kOnArc_m / arc.radius_m;
}

Eigen::AlignedBox2d BoxAround(const Arc& arc) {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(arc.radius_m + kOnArc_m);
  return {arc.center - reach, arc.center + reach};
}

std::vector<SourcedArc> ArcsOf(const Drawing& drawing, const std::vector<uint32_t>& paths) {
  std::vector<SourcedArc> out;
  for (const uint32_t p : paths) {
    for (const Arc& arc : drawing.paths[p].arcs) out.push_back({arc, p});
  }
  return out;
}

void FindCurves(const Drawing& drawing, const std::vector<SourcedArc>& arcs, WallMass& mass) {
  std::vector<Eigen::AlignedBox2d> boxes;
  for (const SourcedArc& a : arcs) {
    boxes.push_back(BoxAround(a.arc));
    mass.circles.push_back({a.arc.center, a.arc.radius_m});
  }
  const BoxTree<2> tree(std::move(boxes));
  for (const LineMap::Edge& e : mass.map.edges()) {
    const Eigen::Vector2d &a = mass.map.vertices()[e.a], &b = mass.map.vertices()[e.b];
    uint32_t circle = kNone;
    tree.ForEachIn(Eigen::AlignedBox2d(0.5 * (a + b)), [&](uint32_t i) {
      if (i < circle && arcs[i].source == e.source && IsStepAlong(arcs[i].arc, a, b)) circle = i;
    });
    const bool curve = e.source < drawing.paths.size() && drawing.paths[e.source].curved && drawing.paths[e.source].arcs.empty();
    mass.circle_of.push_back(circle);
    mass.is_curved.push_back(circle != kNone || curve);
  }
}

}  // namespace plumb::compiler
