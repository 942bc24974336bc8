// The residuals of the joint problem, templated on the scalar so that Ceres differentiates them. No Ceres types.
//
// Blocks: pose = [qx qy qz qw tx ty tz] of T_map_kf; place = [x y z yaw] of T_plan_map; wall = WallParameter order; plane = [n d] in the
// map frame; bias, level = one number in metres.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "runtime/coupling/wall_frame.h"
#include "runtime/mapping/plane_view.h"
#include "runtime/odometry/planar/pose2.h"

namespace plumb::runtime {

inline constexpr int kPoseSize = 7, kPlaceSize = 4, kPlaneSize = 4;

template <class T>
using Vec3 = Eigen::Matrix<T, 3, 1>;

// A plane of the plan frame in the map frame.
template <class T>
void PlaneToMap(const T* place, const Vec3<T>& n_plan, const T& d_plan, Vec3<T>* n_map, T* d_map) {
  using std::cos;
  using std::sin;
  const T c = cos(place[3]), s = sin(place[3]);
  *n_map = Vec3<T>(c * n_plan.x() + s * n_plan.y(), c * n_plan.y() - s * n_plan.x(), n_plan.z());
  *d_map = d_plan + n_plan.x() * place[0] + n_plan.y() * place[1] + n_plan.z() * place[2];
}

// A plane of the map frame against a keyframe's view of it.
template <class T>
void ViewResidual(const PlaneView& view, const T* pose, const Vec3<T>& n_map, const T& d_map, T* r) {
  const Eigen::Map<const Eigen::Quaternion<T>> q(pose);
  const Eigen::Map<const Vec3<T>> t(pose + 4);
  view.Residual<T>(q.conjugate() * n_map, d_map + n_map.dot(t), r);
}

// A keyframe's view of a wall's face: the planned face, moved with its wall, seen through the range bias.
struct WallViewResidual {
  PlaneView view;
  Face face;
  template <class T>
  bool operator()(const T* pose, const T* place, const T* wall, const T* bias, T* r) const {
    Vec3<T> n, n_map;
    T d, d_map;
    BuiltPlane(face, wall, &n, &d);
    PlaneToMap<T>(place, n, d - bias[0], &n_map, &d_map);
    ViewResidual(view, pose, n_map, d_map, r);
    return true;
  }
};

// A keyframe's view of a floor (up = +1) or ceiling (up = -1) planned at height z_m.
struct LevelViewResidual {
  PlaneView view;
  double z_m = 0, up = 1;
  template <class T>
  bool operator()(const T* pose, const T* place, const T* level, T* r) const {
    const Vec3<T> n(T(0), T(0), T(up));
    Vec3<T> n_map;
    T d_map;
    PlaneToMap<T>(place, n, -up * (z_m + level[0]), &n_map, &d_map);
    ViewResidual(view, pose, n_map, d_map, r);
    return true;
  }
};

// A keyframe's view of a surface that the plan does not have.
struct FreeViewResidual {
  PlaneView view;
  template <class T>
  bool operator()(const T* pose, const T* plane, T* r) const {
    ViewResidual<T>(view, pose, Vec3<T>(plane[0], plane[1], plane[2]), plane[3], r);
    return true;
  }
};

// Motion between two keyframes as odometry has it.
struct OdometryResidual {
  Eigen::Isometry3d T_a_b;
  double sigma_m = 1, sigma_rad = 1;
  template <class T>
  bool operator()(const T* pose_a, const T* pose_b, T* r) const {
    const Eigen::Map<const Eigen::Quaternion<T>> q_a(pose_a), q_b(pose_b);
    const Eigen::Map<const Vec3<T>> t_a(pose_a + 4), t_b(pose_b + 4);
    const Eigen::Quaternion<T> measured = Eigen::Quaterniond(T_a_b.linear()).cast<T>();
    const Vec3<T> translation = q_a.conjugate() * (t_b - t_a) - T_a_b.translation().cast<T>();
    const Eigen::Quaternion<T> turn = measured.conjugate() * (q_a.conjugate() * q_b);
    const T sign = turn.w() < T(0) ? T(-1) : T(1);  // q and -q turn alike
    for (int i = 0; i < 3; ++i) {
      r[i] = translation[i] / sigma_m;
      r[3 + i] = sign * 2.0 * turn.coeffs()[i] / sigma_rad;
    }
    return true;
  }
};

// Motion between two keyframes in the plane, of their levelled frames. R_map_kf = Rz(yaw) * leveling, which is held.
struct LevelStepResidual {
  Pose2 T_a_b;
  Eigen::Matrix3d sqrt_information;         // of (x, y, yaw), in the axes of a
  Eigen::Quaterniond unlevel_a, unlevel_b;  // inverse of leveling
  template <class T>
  bool operator()(const T* pose_a, const T* pose_b, T* r) const {
    const Eigen::Map<const Eigen::Quaternion<T>> q_a(pose_a), q_b(pose_b);
    const Eigen::Map<const Vec3<T>> t_a(pose_a + 4), t_b(pose_b + 4);
    const Eigen::Quaternion<T> yaw_a = q_a * unlevel_a.cast<T>(), yaw_b = q_b * unlevel_b.cast<T>();
    const Vec3<T> step = yaw_a.conjugate() * (t_b - t_a);
    const Eigen::Quaternion<T> turn = yaw_a.conjugate() * yaw_b;
    using std::cos;
    using std::sin;
    // Half the angle's error from the quaternion's z and w: exact to third order, and the same for q and -q.
    const double half = 0.5 * T_a_b.yaw_rad;
    const T s = turn.z() * cos(half) - turn.w() * sin(half), c = turn.w() * cos(half) + turn.z() * sin(half);
    const Vec3<T> e(step.x() - T_a_b.t_m.x(), step.y() - T_a_b.t_m.y(), c < T(0) ? T(-2) * s : T(2) * s);
    Eigen::Map<Vec3<T>> out(r);
    out = sqrt_information.cast<T>() * e;
    return true;
  }
};

// Holds the first keyframe: position and heading by convention, roll and pitch as far as gravity was known.
struct AnchorResidual {
  Eigen::Isometry3d T_map_kf;
  double sigma_m = 1, sigma_yaw_rad = 1, sigma_tilt_rad = 1;
  template <class T>
  bool operator()(const T* pose, T* r) const {
    const Eigen::Map<const Eigen::Quaternion<T>> q(pose);
    const Eigen::Map<const Vec3<T>> t(pose + 4);
    const Eigen::Quaternion<T> turn = q * Eigen::Quaterniond(T_map_kf.linear()).conjugate().cast<T>();  // in map axes
    const T sign = turn.w() < T(0) ? T(-1) : T(1);
    for (int i = 0; i < 3; ++i) {
      r[i] = (t[i] - T_map_kf.translation()[i]) / sigma_m;
      r[3 + i] = sign * 2.0 * turn.coeffs()[i] / (i < 2 ? sigma_tilt_rad : sigma_yaw_rad);
    }
    return true;
  }
};

// (x - mean) * weight per number of the block; weights may be changed between solves.
template <int N>
struct PriorResidual {
  std::array<double, N> mean{};
  const std::array<double, N>* weight = nullptr;
  template <class T>
  bool operator()(const T* x, T* r) const {
    for (int i = 0; i < N; ++i) r[i] = (x[i] - mean[i]) * (*weight)[i];
    return true;
  }
};

}  // namespace plumb::runtime
