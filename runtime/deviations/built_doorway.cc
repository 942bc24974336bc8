#include "runtime/deviations/built_doorway.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/coupling/wall_frame.h"
#include "runtime/matching/door_leaves.h"

namespace plumb::runtime {
namespace {

constexpr double kThreshold_m = 0.2, kLintel_m = 0.15;
constexpr double kSearch_m = 0.5;       // of a jamb, to either side
constexpr double kOtherFrame_m = 0.15;  // beside another opening
constexpr double kMaxStep_m = 0.2;      // of a frame
constexpr double kMinThickness_m = 0.03;
constexpr double kMinParallel = 0.94;  // cos 20 deg, of the passage and the wall's normal

// What a jamb is made of: walls and, of doors, what is no leaf.
std::vector<bool> FixedTriangles(const AGraph& plan) {
  const std::vector<DoorwayId> leaf_of = LeafTriangles(plan);
  std::vector<bool> keep(leaf_of.size());
  for (size_t i = 0; i < keep.size(); ++i) keep[i] = !leaf_of[i].valid() && plan.elements[plan.mesh.triangles[i].element].wall.valid();
  return keep;
}

// The wall's face on that side that is nearest to the doorway along the wall.
const Surface* FaceAt(const AGraph& plan, const WallFrame& frame, const Doorway& d, const Eigen::Vector2d& normal) {
  const Surface* best = nullptr;
  double best_m = 0;
  for (const Surface& s : plan.surfaces) {
    if (s.wall != d.wall || !IsFace(frame, s) || s.normal.head<2>().dot(normal) < 0) continue;
    const Eigen::Vector2d along = (s.end - s.start).normalized();
    const double u = along.dot(d.position.head<2>() - s.start), off_m = std::max({-u, u - s.length_m(), 0.0});
    if (best && off_m >= best_m) continue;
    best = &s;
    best_m = off_m;
  }
  return best;
}

}  // namespace

PlannedDoorways::PlannedDoorways(const AGraph& plan) : plan_(plan), fixed_(plan.mesh, FixedTriangles(plan)) {}

// Level rays from the middle of the opening, at several depths of the wall: the nearest thing is the jamb, the farthest the wall's end.
PlannedJamb PlannedDoorways::JambOf(const Doorway& d, double side, double w_a_m, double w_b_m) const {
  constexpr std::array kDepths = {0.1, 0.25, 0.4, 0.5, 0.6, 0.75, 0.9};
  constexpr std::array kHeights = {0.3, 0.5, 0.7};
  const Eigen::Vector2d across(std::cos(d.yaw_rad), std::sin(d.yaw_rad)), along(-across.y(), across.x());
  const double half_m = 0.5 * d.width_m;
  std::array<double, kHeights.size()> clear, wall;
  for (size_t k = 0; k < kHeights.size(); ++k) {
    double least = half_m, most = 0;
    for (const double depth : kDepths) {
      const Eigen::Vector2d at = d.position.head<2>() + (w_a_m + depth * (w_b_m - w_a_m)) * across;
      Ray ray;
      ray.origin = (Eigen::Vector3d(at.x(), at.y(), d.position.z() + kHeights[k] * d.height_m) - plan_.origin).cast<float>();
      ray.direction = Eigen::Vector3d(side * along.x(), side * along.y(), 0).cast<float>();
      ray.max_range_m = static_cast<float>(half_m + kMaxStep_m);
      const RayHit hit = fixed_.Cast(ray);
      if (!hit.hit() || static_cast<double>(hit.range_m) < half_m - kMaxStep_m) continue;
      least = std::min(least, static_cast<double>(hit.range_m));
      most = std::max(most, static_cast<double>(hit.range_m));
    }
    clear[k] = least;
    wall[k] = std::max(least, std::min(most, half_m));
  }
  std::sort(clear.begin(), clear.end());
  std::sort(wall.begin(), wall.end());
  return {side * clear[1], std::max(0.0, wall[1] - clear[1]), 0};
}

double PlannedDoorways::PlainWallBeside(DoorwayId id, double side) const {
  const Doorway& d = plan_.doorways[id.index()];
  const Wall& wall = plan_.walls[d.wall.index()];
  const Eigen::Vector2d along = side * Eigen::Vector2d(-std::sin(d.yaw_rad), std::cos(d.yaw_rad)), at = d.position.head<2>();
  const double half_m = 0.5 * d.width_m;
  double plain_m = std::min(kSearch_m, std::max(along.dot(wall.axis_start - at), along.dot(wall.axis_end - at)) - half_m);
  const auto stop_at = [&](const Eigen::Vector3d& middle, double width_m, double height_m) {
    if (middle.z() > d.position.z() + d.height_m || middle.z() + height_m < d.position.z()) return;
    const double u = along.dot(middle.head<2>() - at);
    if (u > 0) plain_m = std::min(plain_m, u - 0.5 * width_m - half_m - kOtherFrame_m);
  };
  for (size_t i = 0; i < plan_.doorways.size(); ++i) {
    const Doorway& other = plan_.doorways[i];
    if (i != id.index() && other.wall == d.wall) stop_at(other.position, other.width_m, other.height_m);
  }
  for (const Window& w : plan_.windows) {
    if (w.wall == d.wall) stop_at(w.position, w.width_m, w.height_m);
  }
  return plain_m;
}

std::optional<BuiltDoorway> PlannedDoorways::Built(DoorwayId id, const WallEstimate& wall) const {
  const Doorway& d = plan_.doorways[id.index()];
  const Surface& reference = plan_.surfaces[wall.reference.index()];
  const WallFrame frame{wall.reference,
                        {reference.midpoint().x(), reference.midpoint().y(), 0.5 * (reference.z_min_m + reference.z_max_m)},
                        reference.normal};
  const Eigen::Vector2d across(std::cos(d.yaw_rad), std::sin(d.yaw_rad)), along(-across.y(), across.x()), c = d.position.head<2>();
  if (reference.arc || std::abs(across.dot(reference.normal.head<2>())) < kMinParallel) return std::nullopt;
  // Both faces as planned and as built, on the line through the doorways of the wall, beside the middle of its longest surface.
  const Eigen::Vector2d pivot = c + along.dot(reference.midpoint() - c) * along;
  const double parameters[kNumWallParameters] = {wall.deviation.offset_m, wall.deviation.yaw_rad, 0, wall.thickness_error_m};
  std::array<std::optional<double>, 2> planned, moved;
  for (const int k : {0, 1}) {
    const Surface* s = FaceAt(plan_, frame, d, k == 0 ? Eigen::Vector2d(-across) : across);
    if (!s) continue;
    const Face face = MakeFace(frame, *s);
    Plane built;
    BuiltPlane(face, parameters, &built.n, &built.d);
    planned[static_cast<size_t>(k)] = across.dot(s->midpoint() - c);
    const Eigen::Vector3d at(pivot.x(), pivot.y(), face.point.z());
    moved[static_cast<size_t>(k)] = -built.SignedDistance(at) / built.n.head<2>().dot(across);
  }
  if (!planned[0] && !planned[1]) return std::nullopt;
  const double thickness_m = plan_.walls[d.wall.index()].thickness_m;
  for (const size_t k : {0u, 1u}) {
    const double sign = k == 0 ? -1.0 : 1.0;
    if (!planned[k]) planned[k] = *planned[1 - k] + sign * thickness_m;
    if (!moved[k]) moved[k] = *moved[1 - k] + sign * thickness_m;
  }
  if (*planned[1] - *planned[0] < kMinThickness_m) return std::nullopt;
  BuiltDoorway out;
  out.doorway = id;
  out.wall = d.wall;
  const Eigen::Rotation2Dd turn(wall.deviation.yaw_rad);
  out.along = turn * along;
  out.across = turn * across;
  const double middle_m = 0.5 * (*moved[0] + *moved[1]), planned_middle_m = 0.5 * (*planned[0] + *planned[1]);
  out.origin = pivot + (middle_m - planned_middle_m) * across + turn * (c - pivot);
  out.w_a_m = planned_middle_m - 0.5 * (*moved[1] - *moved[0]) * std::cos(wall.deviation.yaw_rad);
  out.w_b_m = planned_middle_m + 0.5 * (*moved[1] - *moved[0]) * std::cos(wall.deviation.yaw_rad);
  out.z_min_m = d.position.z() + kThreshold_m;
  out.z_max_m = d.position.z() + d.height_m - kLintel_m;
  out.right = JambOf(d, -1, *planned[0], *planned[1]);
  out.left = JambOf(d, 1, *planned[0], *planned[1]);
  out.right.outward_m = PlainWallBeside(id, -1);
  out.left.outward_m = PlainWallBeside(id, 1);
  return out;
}

}  // namespace plumb::runtime
