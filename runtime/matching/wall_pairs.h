// Which map wall lies on which face of the plan under a pose.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "runtime/matching/map_view.h"
#include "runtime/matching/plan_index.h"
#include "runtime/matching/planar_pose.h"

namespace plumb::runtime {

inline constexpr double kMaxPairOffset_m = 0.6;  // a built wall further off its plan is not taken for it

// A map wall on a plan face: the part of the map wall, from p to q (MapView frame), that lies along the face.
struct WallPair {
  size_t wall = 0, face = 0;  // MapView::walls, PlanIndex::faces
  Eigen::Vector2d p = Eigen::Vector2d::Zero(), q = Eigen::Vector2d::Zero();
  double overlap_m = 0;
};

// Signed distance of the map point p from a plan face under a pose, and its derivatives by (x, y, yaw, scale about the map's centre).
[[nodiscard]] inline double FaceDistance(const PlanFace& face, const PlanarPose& pose, const Eigen::Vector2d& p,
                                         Eigen::Vector4d* jacobian) {
  const Eigen::Vector2d turned = pose.rotation() * p;
  if (jacobian != nullptr) {
    const Eigen::Vector2d by_yaw(-turned.y(), turned.x());
    *jacobian << face.normal, face.normal.dot(by_yaw), face.normal.dot(turned);
  }
  return face.normal.dot(turned + pose.t_m) + face.d_m;
}

// They face the same way and lie in one plane, to within what plans are drawn to.
[[nodiscard]] bool AreCoplanar(const PlanFace& a, const PlanFace& b);

// For each map wall the face that takes most of it, nearest, and the faces in the same plane that take the rest.
[[nodiscard]] std::vector<WallPair> PairWalls(const PlanIndex& plan, const MapView& map, const PlanarPose& pose);

}  // namespace plumb::runtime
