// How a physical wall stands off its plan: one rigid motion for all its faces, in the wall-centred form (runtime/METHOD.md).
//
// The motion refers to the wall's reference surface: turn by `yaw` about +z and by `tilt` about the wall's own direction, both
// through the reference surface's midpoint, then move by `offset` along the reference normal. A thickness error moves each face half
// of it outwards. Frame: plan.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "runtime/mapping/sgraph.h"
#include "schema/agraph.h"

namespace plumb::runtime {

// Order of a wall's parameters wherever they stand in one array.
enum WallParameter : int { kWallOffset = 0, kWallYaw = 1, kWallTilt = 2, kWallThickness = 3, kNumWallParameters = 4 };

struct WallFrame {
  SurfaceId reference;  // the wall's longest straight surface, the lowest id of equals; none: the wall has no straight surface
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();     // its midpoint at half its height
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();   // its normal
  [[nodiscard]] bool valid() const { return reference.valid(); }
};

// One per plan wall. Depends on the plan alone, so that a wall's numbers keep their meaning as more of it is seen.
[[nodiscard]] std::vector<WallFrame> WallFrames(const AGraph& plan);

// One face of a wall, as far as the wall's motion concerns it.
struct Face {
  Eigen::Vector3d pivot, wall_normal;    // of the wall
  Eigen::Vector3d normal, point;         // of the face as planned; the point is its midpoint at half its height
  // +1 or -1: the face looks along or against the reference normal.
  [[nodiscard]] double side() const { return wall_normal.dot(normal) >= 0 ? 1.0 : -1.0; }
};

// True for straight surfaces parallel to the wall's reference: the faces that the wall's offset moves along their normal. Ends of walls,
// reveals and curved surfaces are not.
[[nodiscard]] bool IsFace(const WallFrame& frame, const Surface& surface);
// The side of its wall that a face is of, different for all walls: 2 * wall id, and 1 more if it faces along the wall's reference normal.
[[nodiscard]] int SideOf(const WallFrame& frame, const Surface& face);
[[nodiscard]] Face MakeFace(const WallFrame& frame, const Surface& surface);

// The built plane n . x + d = 0 of a face whose wall moved by `wall` (offset, yaw, tilt, thickness). T: double or an autodiff scalar.
template <class T>
void BuiltPlane(const Face& face, const T* wall, Eigen::Matrix<T, 3, 1>* n, T* d) {
  using std::cos;
  using std::sin;
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  const T cy = cos(wall[kWallYaw]), sy = sin(wall[kWallYaw]), ct = cos(wall[kWallTilt]), st = sin(wall[kWallTilt]);
  const Eigen::Vector3d along = face.wall_normal.cross(Eigen::Vector3d::UnitZ()).normalized();
  const auto rotate = [&](const Eigen::Vector3d& x) {  // Rz(yaw) * rotation by tilt about `along`, which lifts the wall's normal towards +z
    const Eigen::Vector3d parallel = along * along.dot(x), across = along.cross(x);
    const Vector3 t = parallel.cast<T>() + (x - parallel).cast<T>() * ct + across.cast<T>() * st;
    return Vector3(cy * t.x() - sy * t.y(), sy * t.x() + cy * t.y(), t.z());
  };
  *n = rotate(face.normal);
  const Vector3 arm = rotate(face.point - face.pivot);
  *d = -(n->dot(face.pivot.cast<T>() + arm) + wall[kWallOffset] * n->dot(face.wall_normal.cast<T>()) + T(0.5) * wall[kWallThickness]);
}

// How a built plane stands to a planned face: displacement at the face's own midpoint along its normal, and turn about +z.
struct FaceDeviation {
  double offset_m = 0, yaw_rad = 0, tilt_rad = 0;
};
[[nodiscard]] FaceDeviation CompareToPlan(const Face& face, const Plane& built);

}  // namespace plumb::runtime
