// What a view says of a plane and of the pose that it was seen from, to first order.
#pragma once

#include <Eigen/Geometry>

#include "runtime/mapping/plane_view.h"
#include "runtime/odometry/registration.h"

namespace plumb::runtime {

// Whitened, in the order of PlaneView::Residual().
struct ViewEquations {
  Eigen::Vector3d residual;
  Eigen::Matrix3d by_plane;             // (a, b, c): turned towards a = n.unitOrthogonal() and b = n x a about `at`, shifted by c along n
  Eigen::Matrix<double, 3, 6> by_pose;  // of T's increment (rotation, translation; registration.h)
};
// `T`: of the view's keyframe in the frame of `plane`; `at`: a point of that plane. Exact derivatives at the given values.
[[nodiscard]] ViewEquations EquationsOf(const PlaneView& view, const Eigen::Isometry3d& T, const Plane& plane, const Eigen::Vector3d& at);

}  // namespace plumb::runtime
