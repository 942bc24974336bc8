#include "compiler/passes/vertical_probe.h"

#include <algorithm>
#include <cmath>

#include "compiler/passes/polygon.h"
#include "compiler/passes/section.h"

namespace plumb::compiler {
namespace {

constexpr double kSlack = 1e-9;  // rays through the seam of two triangles must not slip between them

// Height of the triangle over `p`; none beside it and for upright triangles.
std::optional<double> HeightAt(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector2d& p) {
  const Eigen::Vector2d u = (b - a).head<2>(), v = (c - a).head<2>(), w = p - a.head<2>();
  const double det = Cross(u, v);
  if (std::abs(det) < 1e-12) return std::nullopt;
  const double s = Cross(w, v) / det, t = Cross(u, w) / det;
  if (s < -kSlack || t < -kSlack || s + t > 1 + kSlack) return std::nullopt;
  return a.z() + s * (b.z() - a.z()) + t * (c.z() - a.z());
}

const Eigen::Vector3d& CornerOf(const Solid& solid, uint32_t triangle, int k) {
  return solid.vertices[static_cast<size_t>(solid.triangles[triangle][k])];
}

// By the slack that HeightAt allows, of the box's size, on each side.
Eigen::AlignedBox2d Grown(Eigen::AlignedBox2d box) {
  const Eigen::Vector2d margin = 4 * kSlack * box.sizes();
  box.min() -= margin;
  box.max() += margin;
  return box;
}

}  // namespace

VerticalProbe::VerticalProbe(const PlanIr& plan, std::initializer_list<ElementKind> kinds) {
  std::vector<Eigen::AlignedBox2d> boxes;
  for (const PlanElement& e : plan.elements) {
    if (std::find(kinds.begin(), kinds.end(), e.kind) == kinds.end()) continue;
    for (uint32_t t = 0; t < e.body.triangles.size(); ++t) {
      Eigen::AlignedBox2d box;
      for (int k = 0; k < 3; ++k) box.extend(CornerOf(e.body, t, k).head<2>());
      targets_.push_back({&e.body, t});
      boxes.push_back(Grown(box));
    }
  }
  tree_ = BoxTree<2>(std::move(boxes));
}

template <class Visit>
void VerticalProbe::ForEachHit(const Eigen::Vector2d& p, const Visit& visit) const {
  tree_.ForEachIn(Eigen::AlignedBox2d(p), [&](uint32_t i) {
    const auto& [solid, t] = targets_[i];
    if (const auto z = HeightAt(CornerOf(*solid, t, 0), CornerOf(*solid, t, 1), CornerOf(*solid, t, 2), p)) visit(*z);
  });
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
