// What one keyframe's view of a planar surface says: its points' moments as a whitened 3-row residual (runtime/METHOD.md, pi-factor).
#pragma once

#include <Eigen/Core>

#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// Centre, principal directions and variances of points. Exact: sum of squared distances to a plane (n, d) is
// count * ((n.c + d)^2 + var_u (n.u)^2 + var_v (n.v)^2 + var_normal (n.normal)^2).
struct PlaneMoments {
  double count = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d u = Eigen::Vector3d::UnitX(), v = Eigen::Vector3d::UnitY(), normal = Eigen::Vector3d::UnitZ();
  double var_u = 0, var_v = 0, var_normal = 0;  // descending, never negative
};
[[nodiscard]] PlaneMoments ComputeMoments(const PlaneStats& stats);

struct ViewNoise {
  double point_sigma_m = 0.03, correlation = 10, floor_m = 0.005, floor_rad = 0.003;
  double edge_m2 =
      0.002;         // height times width of what clings to a surface's edge (frames, skirtings, rounded corners): it turns short views
  Smear smear = {};  // of what the keyframe saw, by its unknown motion
};

// Residual of a predicted plane (n, d) in the view's frame: [(n.c + d) w_c, n.u w_u, n.v w_v]; zero on the points' own plane.
struct PlaneView {
  PlaneView() = default;
  // num_views: of this surface. What clings to its edge is in all of them and does not average out.
  PlaneView(const PlaneStats& stats, const ViewNoise& noise, size_t num_views = 1);

  template <class T>
  void Residual(const Eigen::Matrix<T, 3, 1>& n, const T& d, T* r) const {
    r[0] = (n.dot(center.cast<T>()) + d) * weight_center;
    r[1] = n.dot(u.cast<T>()) * weight_u;
    r[2] = n.dot(v.cast<T>()) * weight_v;
  }

  Eigen::Vector3d center = Eigen::Vector3d::Zero(), u = Eigen::Vector3d::UnitX(), v = Eigen::Vector3d::UnitY();
  double weight_center = 0, weight_u = 0, weight_v = 0;  // 1 / sigma of the offset at the centre, of the turns about v and about u
};

}  // namespace plumb::runtime
