#include "runtime/mapping/view_equations.h"

namespace plumb::runtime {

ViewEquations EquationsOf(const PlaneView& view, const Eigen::Isometry3d& T, const Plane& plane, const Eigen::Vector3d& at) {
  const Eigen::Vector3d& n = plane.n;
  const Eigen::Vector3d a = n.unitOrthogonal(), b = n.cross(a);
  const Eigen::Vector3d center = T * view.center, u = T.linear() * view.u, v = T.linear() * view.v;
  ViewEquations e;
  e.residual << plane.SignedDistance(center) * view.weight_center, n.dot(u) * view.weight_u, n.dot(v) * view.weight_v;
  e.by_plane << a.dot(center - at), b.dot(center - at), 1, a.dot(u), b.dot(u), 0, a.dot(v), b.dot(v), 0;
  e.by_pose << (center - T.translation()).cross(n).transpose(), n.transpose(), u.cross(n).transpose(), Eigen::RowVector3d::Zero(),
      v.cross(n).transpose(), Eigen::RowVector3d::Zero();
  const Eigen::Vector3d weights(view.weight_center, view.weight_u, view.weight_v);
  e.by_plane = weights.asDiagonal() * e.by_plane;
  e.by_pose = weights.asDiagonal() * e.by_pose;
  return e;
}

}  // namespace plumb::runtime
