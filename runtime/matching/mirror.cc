#include "runtime/matching/mirror.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace plumb::runtime {
namespace {

constexpr double kSamePlane_m = 0.05, kSameDoor_m = 0.2, kSameNormal = 0.999;
constexpr double kOwnMirrorRatio = 0.95, kSeenMirrorRatio = 0.97;  // of the length of all walls, and of those that the map lies on
constexpr double kNearWall_m = 1.0;

// The reflection of the plan that a map at `pose` in it and at `mirrored_pose` in its mirror image amounts to.
class Reflection {
 public:
  Reflection(const PlanarPose& pose, const PlanarPose& mirrored_pose)
      : turn_(mirrored_pose.rotation() * pose.rotation().transpose()), from_m_(pose.t_m), to_m_(mirrored_pose.t_m) {}

  [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector2d& x) const {
    const Eigen::Vector2d y = turn_ * (x - from_m_) + to_m_;
    return {-y.x(), y.y()};
  }

 private:
  Eigen::Matrix2d turn_;
  Eigen::Vector2d from_m_, to_m_;
};

// Of a face, that the reflection takes onto faces of the plan.
double CoveredLength(const PlanIndex& plan, const PlanFace& face, const Reflection& reflection) {
  const Eigen::Vector2d start = reflection(face.end), end = reflection(face.start);  // swapped: free space stays to the left
  const Eigen::Vector2d along = (end - start) / face.length_m, middle = 0.5 * (start + end);
  double covered_m = 0;
  for (const PlanFace& other : plan.faces()) {
    if (other.along.dot(along) < kSameNormal || std::abs(other.normal.dot(middle) + other.d_m) > kSamePlane_m) continue;
    if (std::min(face.z_max_m, other.z_max_m) <= std::max(face.z_min_m, other.z_min_m)) continue;
    const double u0 = other.along.dot(start - other.start), u1 = other.along.dot(end - other.start);
    covered_m += std::max(0.0, std::min(u1, other.length_m) - std::max(u0, 0.0));
  }
  return std::min(covered_m, face.length_m);
}

bool NearWallSeen(const WallFit& fit, const Eigen::Vector2d& place) {
  const Eigen::Vector2d at = fit.pose.rotation().transpose() * (place - fit.pose.t_m);
  return std::any_of(fit.pairs.begin(), fit.pairs.end(), [&](const WallPair& pair) {
    const Eigen::Vector2d way = pair.q - pair.p;
    const double along = std::clamp(way.dot(at - pair.p) / way.squaredNorm(), 0.0, 1.0);
    return (pair.p + along * way - at).norm() < kNearWall_m;
  });
}

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

bool IsOwnMirrorImage(const PlanIndex& plan, const WallFit& fit, const PlanarPose& mirrored_pose) {
  const Reflection reflection(fit.pose, mirrored_pose);
  std::vector<bool> seen(plan.faces().size(), false);
  for (const WallPair& pair : fit.pairs) seen[pair.face] = true;
  double total_m = 0, onto_m = 0, seen_m = 0, seen_onto_m = 0;
  for (size_t k = 0; k < plan.faces().size(); ++k) {
    const PlanFace& face = plan.faces()[k];
    const double covered_m = CoveredLength(plan, face, reflection);
    total_m += face.length_m;
    onto_m += covered_m;
    if (!seen[k]) continue;
    seen_m += face.length_m;
    seen_onto_m += covered_m;
  }
  if (onto_m < kOwnMirrorRatio * total_m || seen_onto_m < kSeenMirrorRatio * seen_m) return false;
  // Doorways of the walls seen only: elsewhere they may differ.
  const std::vector<Doorway>& doorways = plan.plan().doorways;
  const Eigen::Vector3d& origin = plan.plan().origin;
  return std::all_of(doorways.begin(), doorways.end(), [&](const Doorway& d) {
    const Eigen::Vector2d place = (d.position - origin).head<2>(), at = reflection(place);
    if (!NearWallSeen(fit, place)) return true;
    return std::any_of(doorways.begin(), doorways.end(), [&](const Doorway& other) {
      const Eigen::Vector3d v = other.position - origin;
      return (v.head<2>() - at).norm() < kSameDoor_m && std::abs(v.z() + origin.z() - d.position.z()) < kSameDoor_m;
    });
  });
}

}  // namespace plumb::runtime
