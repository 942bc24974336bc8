#include "compiler/passes/vertical_probe.h"

#include <algorithm>
#include <cmath>

#include "compiler/passes/polygon.h"
#include "compiler/passes/section.h"

namespace plumb::compiler {
namespace {

// Height of the triangle over `p`; none beside it and for upright triangles.
std::optional<double> HeightAt(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector2d& p) {
  const Eigen::Vector2d u = (b - a).head<2>(), v = (c - a).head<2>(), w = p - a.head<2>();
  const double det = Cross(u, v);
  if (std::abs(det) < 1e-12) return std::nullopt;
  const double s = Cross(w, v) / det, t = Cross(u, w) / det;
  constexpr double kSlack = 1e-9;  // rays through the seam of two triangles must not slip between them
  if (s < -kSlack || t < -kSlack || s + t > 1 + kSlack) return std::nullopt;
  return a.z() + s * (b.z() - a.z()) + t * (c.z() - a.z());
}

}  // namespace

VerticalProbe::VerticalProbe(const PlanIr& plan, std::initializer_list<ElementKind> kinds) {
  for (const PlanElement& e : plan.elements) {
    if (std::find(kinds.begin(), kinds.end(), e.kind) == kinds.end() || e.body.empty()) continue;
    targets_.push_back({&e.body, Bounds(e.body)});
  }
}

template <class Visit>
void VerticalProbe::ForEachHit(const Eigen::Vector2d& p, const Visit& visit) const {
  for (const Target& target : targets_) {
    if ((p.array() < target.box.min().head<2>().array()).any() || (p.array() > target.box.max().head<2>().array()).any()) continue;
    const auto& v = target.solid->vertices;
    for (const Eigen::Vector3i& t : target.solid->triangles) {
      const auto z = HeightAt(v[static_cast<size_t>(t[0])], v[static_cast<size_t>(t[1])], v[static_cast<size_t>(t[2])], p);
      if (z) visit(*z);
    }
  }
}

std::optional<double> VerticalProbe::Above(const Eigen::Vector2d& p, double z_m) const {
  std::optional<double> best;
  ForEachHit(p, [&](double z) {
    if (z >= z_m && (!best || z < *best)) best = z;
  });
  return best;
}

std::optional<double> VerticalProbe::Below(const Eigen::Vector2d& p, double z_m) const {
  std::optional<double> best;
  ForEachHit(p, [&](double z) {
    if (z <= z_m && (!best || z > *best)) best = z;
  });
  return best;
}

}  // namespace plumb::compiler
