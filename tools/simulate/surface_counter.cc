#include "tools/simulate/surface_counter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace plumb::tools {
namespace {

constexpr double kOnPlane_m = 0.02;   // faces may bow or step this much
constexpr double kBeyondEnd_m = 0.8;  // walls are lengthened to meet others that moved
constexpr double kFacing_cos = 0.9;   // reveals end at a face, but are none of it

// How far p is from the surface's stretch of its line, along it; negative inside.
double BeyondEnd_m(const Surface& s, const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = (s.end - s.start).normalized();
  return std::abs((p - s.midpoint()).dot(along)) - 0.5 * s.length_m();
}

double OffPlane_m(const Surface& s, const Eigen::Vector2d& p) {
  if (s.arc) return std::abs((p - s.arc->center).norm() - s.arc->radius_m);
  return std::abs(s.normal.head<2>().dot(p) + s.d_m);
}

Eigen::Vector3d NormalOf(const Mesh& mesh, const Triangle& t) {
  const Eigen::Vector3d a = mesh.vertices[t.a].cast<double>();
  return (mesh.vertices[t.b].cast<double>() - a).cross(mesh.vertices[t.c].cast<double>() - a).normalized();
}

// Of the wall as planned.
bool LiesAlong(const Surface& s, const Eigen::Vector2d& p, const Eigen::Vector3d& normal) {
  const Eigen::Vector2d across = s.arc ? (p - s.arc->center).normalized() : Eigen::Vector2d(s.normal.head<2>());
  return std::abs(normal.head<2>().dot(across)) > kFacing_cos;
}

}  // namespace

SurfaceCounter::SurfaceCounter(const AGraph& plan, const AsBuilt& built) : plan_(plan), built_(built), of_wall_(plan.walls.size()) {
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    if (plan.surfaces[i].wall.valid()) of_wall_[plan.surfaces[i].wall.index()].emplace_back(i);
  }
}

SurfaceHit SurfaceCounter::HitOf(const Echo& echo) const {
  const Triangle& triangle = built_.house.mesh.triangles[echo.triangle];
  const Element& element = built_.house.elements[triangle.element];
  if (!IsWallBody(element)) return {};
  const size_t wall = element.wall.index();
  const Eigen::Vector3d built = echo.position.cast<double>() + plan_.origin;
  const Eigen::Vector2d p = built_.motions[wall].inverse() * built.head<2>();  // where the plan has this spot
  Eigen::Vector3d normal = NormalOf(built_.house.mesh, triangle);
  normal.head<2>() = built_.motions[wall].linear().transpose() * normal.head<2>().eval();
  SurfaceHit best;
  double best_m = kBeyondEnd_m;
  for (const SurfaceId id : of_wall_[wall]) {
    const Surface& s = plan_.surfaces[id.index()];
    if (OffPlane_m(s, p) > kOnPlane_m || built.z() < s.z_min_m - 0.05 || built.z() > s.z_max_m + 0.05) continue;
    if (!LiesAlong(s, p, normal)) continue;
    const double beyond_m = std::max(0.0, BeyondEnd_m(s, p));
    if (beyond_m < best_m) {
      best = {id, (p - s.start).dot((s.end - s.start).normalized()), built.z()};
      best_m = beyond_m;
    }
  }
  return best;
}

}  // namespace plumb::tools
