#include "schema/polygon.h"

#include <algorithm>
#include <limits>

namespace plumb {

bool Contains(std::span<const Eigen::Vector2d> ring, const Eigen::Vector2d& p) {
  bool inside = false;
  for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Eigen::Vector2d &a = ring[i], &b = ring[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

bool Contains(const Room& room, const Eigen::Vector2d& p) {
  return Contains(room.polygon, p) &&
         std::none_of(room.holes.begin(), room.holes.end(), [&](const Ring& hole) { return Contains(hole, p); });
}

Eigen::Vector2d NearestOnSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double length2 = along.squaredNorm();
  return a + (length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0) * along;
}

double DistanceToSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (p - NearestOnSegment(p, a, b)).norm();
}

double DistanceToRing(std::span<const Eigen::Vector2d> ring, const Eigen::Vector2d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < ring.size(); ++i) nearest = std::min(nearest, DistanceToSegment(p, ring[i], ring[(i + 1) % ring.size()]));
  return nearest;
}

RoomId RoomAt(const AGraph& graph, const Eigen::Vector3d& p) {
  constexpr double kMargin_m = 0.3;
  for (size_t i = 0; i < graph.rooms.size(); ++i) {
    const Room& room = graph.rooms[i];
    if (p.z() < room.floor_z_m - kMargin_m || p.z() > room.ceiling_z_m + kMargin_m) continue;
    if (Contains(room, p.head<2>())) return RoomId(i);
  }
  return {};
}

}  // namespace plumb
