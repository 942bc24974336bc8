#include "runtime/matching/mirror.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace plumb::runtime {
namespace {

constexpr double kSamePlane_m = 0.05, kSameDoor_m = 0.2, kSameNormal = 0.999;
constexpr double kOwnMirrorRatio = 0.97;  // of the wall length

}  // namespace

AGraph MirrorImage(const AGraph& plan) {
  AGraph image;
  image.origin = plan.origin;
  image.storeys = plan.storeys;
  image.walls = plan.walls;  // matching reads their thickness only
  image.surfaces = plan.surfaces;
  image.rooms = plan.rooms;  // ... and of rooms heights and area
  image.doorways = plan.doorways;
  image.windows = plan.windows;
  image.columns = plan.columns;
  image.elements = plan.elements;
  const auto flip = [&](double& x) { x = 2 * plan.origin.x() - x; };
  for (Surface& s : image.surfaces) {
    std::swap(s.start, s.end);
    flip(s.start.x());
    flip(s.end.x());
    s.normal.x() = -s.normal.x();
    s.d_m = -s.normal.head<2>().dot(s.start);
    if (!s.arc) continue;
    flip(s.arc->center.x());
    s.arc->start_rad = WrapAngle(std::numbers::pi - s.arc->start_rad);
    s.arc->sweep_rad = -s.arc->sweep_rad;
  }
  for (Doorway& d : image.doorways) flip(d.position.x());
  for (Window& w : image.windows) flip(w.position.x());
  for (Column& c : image.columns) {
    for (Eigen::Vector2d& p : c.outline) flip(p.x());
  }
  return image;
}

bool IsOwnMirrorImage(const PlanIndex& plan, const PlanarPose& pose, const PlanarPose& mirrored_pose) {
  // Plan -> map -> mirror image -> plan.
  const Eigen::Matrix2d R = mirrored_pose.rotation() * pose.rotation().transpose();
  const auto reflect = [&](const Eigen::Vector2d& x) -> Eigen::Vector2d {
    const Eigen::Vector2d y = R * (x - pose.t_m) + mirrored_pose.t_m;
    return {-y.x(), y.y()};
  };
  double total_m = 0, onto_m = 0;
  for (const PlanFace& face : plan.faces()) {
    total_m += face.length_m;
    const Eigen::Vector2d start = reflect(face.end), end = reflect(face.start);  // swapped: free space stays to the left
    const Eigen::Vector2d along = (end - start) / face.length_m, middle = 0.5 * (start + end);
    double covered_m = 0;
    for (const PlanFace& other : plan.faces()) {
      if (other.along.dot(along) < kSameNormal || std::abs(other.normal.dot(middle) + other.d_m) > kSamePlane_m) continue;
      if (std::min(face.z_max_m, other.z_max_m) <= std::max(face.z_min_m, other.z_min_m)) continue;
      const double u0 = other.along.dot(start - other.start), u1 = other.along.dot(end - other.start);
      covered_m += std::max(0.0, std::min(u1, other.length_m) - std::max(u0, 0.0));
    }
    onto_m += std::min(covered_m, face.length_m);
  }
  if (onto_m < kOwnMirrorRatio * total_m) return false;
  const std::vector<Doorway>& doorways = plan.plan().doorways;
  const Eigen::Vector3d& origin = plan.plan().origin;
  return std::all_of(doorways.begin(), doorways.end(), [&](const Doorway& d) {
    const Eigen::Vector2d at = reflect((d.position - origin).head<2>());
    return std::any_of(doorways.begin(), doorways.end(), [&](const Doorway& other) {
      const Eigen::Vector3d v = other.position - origin;
      return (v.head<2>() - at).norm() < kSameDoor_m && std::abs(v.z() + origin.z() - d.position.z()) < kSameDoor_m;
    });
  });
}

}  // namespace plumb::runtime
