#include "runtime/deviations/planned_things.h"

#include <algorithm>

namespace plumb::runtime {
namespace {

constexpr double kOnThing_m = 0.10;  // of what is seen from where it is planned

std::vector<bool> Things(const AGraph& plan) {
  std::vector<bool> keep(plan.mesh.triangles.size());
  for (size_t i = 0; i < keep.size(); ++i) {
    const Element& e = plan.elements[plan.mesh.triangles[i].element];
    keep[i] = !e.wall.valid() && !e.doorway.valid() && e.kind != ElementKind::kWall && e.kind != ElementKind::kCurtainWall &&
              e.kind != ElementKind::kCovering;
  }
  return keep;
}

}  // namespace

PlannedThings::PlannedThings(const AGraph& plan) : origin_(plan.origin), caster_(plan.mesh, Things(plan)) {}

bool PlannedThings::IsOneAt(const Sight& sight) const {
  const double length_m = (sight.to - sight.from).norm();
  Ray ray;
  ray.direction = ((sight.to - sight.from) / length_m).cast<float>();
  ray.origin = (sight.to - origin_).cast<float>() - static_cast<float>(std::min(length_m, kOnThing_m)) * ray.direction;
  ray.max_range_m = static_cast<float>(2 * kOnThing_m);
  return caster_.Cast(ray).hit();
}

}  // namespace plumb::runtime
