#include "runtime/coupling/wall_frame.h"

#include <algorithm>

namespace plumb::runtime {
namespace {

constexpr double kMinParallel = 0.94;  // cos 20 deg

Eigen::Vector3d MidpointAtHalfHeight(const Surface& s) {
  const Eigen::Vector2d m = s.midpoint();
  return {m.x(), m.y(), 0.5 * (s.z_min_m + s.z_max_m)};
}

}  // namespace

std::vector<WallFrame> WallFrames(const AGraph& plan) {
  std::vector<WallFrame> frames(plan.walls.size());
  std::vector<double> longest(plan.walls.size(), 0);
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    const Surface& s = plan.surfaces[i];
    // A difference below a millimetre is rounding: the lower id stays.
    if (!s.wall.valid() || s.arc || std::abs(s.normal.z()) > 0.5 || s.length_m() <= longest[s.wall.index()] + 1e-3) continue;
    longest[s.wall.index()] = s.length_m();
    frames[s.wall.index()] = {SurfaceId(i), MidpointAtHalfHeight(s), s.normal};
  }
  return frames;
}

bool IsFace(const WallFrame& frame, const Surface& surface) {
  return frame.valid() && !surface.arc && std::abs(frame.normal.dot(surface.normal)) > kMinParallel;
}

int SideOf(const WallFrame& frame, const Surface& face) {
  return static_cast<int>(2 * face.wall.value) + (frame.normal.dot(face.normal) > 0 ? 1 : 0);
}

Face MakeFace(const WallFrame& frame, const Surface& surface) {
  return {frame.pivot, frame.normal, surface.normal, MidpointAtHalfHeight(surface)};
}

FaceDeviation CompareToPlan(const Face& face, const Plane& built) {
  const Eigen::Vector3d& n = face.normal;
  FaceDeviation out;
  out.offset_m = -built.SignedDistance(face.point) / built.n.dot(n);
  out.yaw_rad = std::atan2(n.x() * built.n.y() - n.y() * built.n.x(), n.x() * built.n.x() + n.y() * built.n.y());
  out.tilt_rad = std::asin(std::clamp(built.n.z(), -1.0, 1.0)) - std::asin(std::clamp(n.z(), -1.0, 1.0));
  return out;
}

}  // namespace plumb::runtime
