// Which polygon, and which room, a point lies in, and how far it is from one.
#pragma once

#include <Eigen/Core>
#include <span>

#include "schema/agraph.h"

namespace plumb {

// Is p inside the ring (not closed: the last point is not the first again)? Points on the boundary may be either. O(n).
[[nodiscard]] bool Contains(std::span<const Eigen::Vector2d> ring, const Eigen::Vector2d& p);

// Is p inside the room's polygon and in none of its holes?
[[nodiscard]] bool Contains(const Room& room, const Eigen::Vector2d& p);

// Of the segment from a to b, which may be a point.
[[nodiscard]] Eigen::Vector2d NearestOnSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b);
[[nodiscard]] double DistanceToSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b);

// To the ring's nearest edge, whether p is inside or not; infinite for an empty ring. O(n).
[[nodiscard]] double DistanceToRing(std::span<const Eigen::Vector2d> ring, const Eigen::Vector2d& p);

// The room that p (plan frame) is in: between its floor and its ceiling, 0.3 m more either way. None outside of all. O(corners of all
// rooms).
[[nodiscard]] RoomId RoomAt(const AGraph& graph, const Eigen::Vector3d& p);

}  // namespace plumb
