// The S-Graph: what the robot has seen. Keyframes and the wall surfaces, floors and ceilings observed from them, in the `map` frame
// (odometry's start, gravity-aligned). Grows scan by scan; poses and planes are re-estimated by optimization/.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/mapping/smear.h"
#include "runtime/odometry/planar/pose2.h"

namespace plumb::runtime {

// Sum of homogeneous outer products of points, sum [p;1][p;1]^T: all that point-to-plane residuals need (runtime/METHOD.md, pi-factor).
struct PlaneStats {
  Eigen::Matrix4d C = Eigen::Matrix4d::Zero();

  void Add(const Eigen::Vector3d& p) {
    const Eigen::Vector4d h = p.homogeneous();
    C += h * h.transpose();
  }
  void Add(const PlaneStats& other) { C += other.C; }
  [[nodiscard]] double count() const { return C(3, 3); }
  [[nodiscard]] Eigen::Vector3d centroid() const { return C.block<3, 1>(0, 3) / C(3, 3); }
  // Of the points moved by T.
  [[nodiscard]] PlaneStats Transformed(const Eigen::Isometry3d& T) const { return {T.matrix() * C * T.matrix().transpose()}; }
};

// Plane n . x + d = 0, n a unit vector into the free space (towards the sensor that saw it).
struct Plane {
  Eigen::Vector3d n = Eigen::Vector3d::UnitX();
  double d = 0;
  // The plane in frame a, given it in frame b.
  [[nodiscard]] Plane Transformed(const Eigen::Isometry3d& T_a_b) const {
    const Eigen::Vector3d n_a = T_a_b.linear() * n;
    return {n_a, d - n_a.dot(T_a_b.translation())};
  }
  [[nodiscard]] double SignedDistance(const Eigen::Vector3d& p) const { return n.dot(p) + d; }
};

enum class SurfaceKind : uint8_t { kWall, kFloor, kCeiling };

// A planar patch seen from one keyframe, in the keyframe's frame.
struct Segment {
  SurfaceKind kind = SurfaceKind::kWall;
  Plane plane;
  PlaneStats stats;                    // of all points in the band about the plane, not only of the thinned ones
  std::vector<Eigen::Vector3f> cells;  // mean point of every occupied 0.1 m x 0.1 m cell
  double cell_height_m = 0.1;          // of the surface that a cell stands for; more in planar scans, which see a wall on one line
};

struct Observation {
  uint32_t keyframe = 0;
  PlaneStats stats;  // keyframe frame
};

// One side of something flat in the building as built. Never merges the two faces of a wall: normals point into free space.
struct MapSurface {
  uint32_t id = 0;
  SurfaceKind kind = SurfaceKind::kWall;
  Plane plane;  // map frame, current estimate
  std::vector<Observation> observations;
  double num_points = 0;
  // Extent, map frame, to about 5 cm. Walls: the footprint from `start` to `end` as in plumb::Surface (free space to the left), and the
  // height band. Floors and ceilings: lowest and highest x and y; the heights are both that of the centroid.
  Eigen::Vector2d start = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();
  double z_min_m = 0, z_max_m = 0;
  // Cells of 0.1 m x 0.1 m of the surface that hold points: what was really seen of it. area_m2 = number of cells * 0.1 m *
  // Segment::cell_height_m. Kept once per surface, fixed to the first keyframe that saw it: when poses change, all cells follow that
  // keyframe.
  double area_m2 = 0;
  // Walls: where those cells are, (distance from `start` towards `end`, height).
  std::vector<Eigen::Vector2f> cells;

  [[nodiscard]] double length_m() const { return (end - start).norm(); }
};

// Of the surface from `keyframe`; null if it has not seen it. Observations are in the keyframes' order.
[[nodiscard]] inline const Observation* FindObservation(const MapSurface& surface, uint32_t keyframe) {
  const auto at = std::lower_bound(surface.observations.begin(), surface.observations.end(), keyframe,
                                   [](const Observation& o, uint32_t k) { return o.keyframe < k; });
  return at != surface.observations.end() && at->keyframe == keyframe ? &*at : nullptr;
}

struct Keyframe {
  uint32_t id = 0;
  double stamp_s = 0;
  Eigen::Isometry3d T_map_kf = Eigen::Isometry3d::Identity();   // current estimate
  Eigen::Isometry3d T_odom_kf = Eigen::Isometry3d::Identity();  // as odometry gave it, never changed
  std::vector<Eigen::Vector3f> points;                          // deskewed, down-sampled, keyframe frame
  // Where the sensor was when it saw them: from `first_point` on up to the next entry's. Empty: always at the keyframe's origin.
  struct Standpoint {
    uint32_t first_point = 0;
    Eigen::Vector3f sensor = Eigen::Vector3f::Zero();  // keyframe frame
  };
  std::vector<Standpoint> standpoints;
  // Along odometry's way from the first keyframe to this one, keyframe by keyframe.
  double travelled_m = 0, turned_rad = 0;
  Smear smear;  // by motion that nobody could take out of its sweeps, as they came without times

  // A keyframe that told nothing new was merged into an older one (keyframe_merging.h): that one has its observations and carries it along.
  struct Merged {
    uint32_t into = 0;  // itself never merged
    Eigen::Isometry3d T_into_kf = Eigen::Isometry3d::Identity();
  };
  std::optional<Merged> merged;
};

// Pose of `to` in `from` as measured; covariance of (x, y, yaw) in the axes of `from`.
struct PoseEdge {
  uint32_t from = 0, to = 0;
  Pose2 T_from_to;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  bool loop = false;  // may be wrong: a robust loss lets it go
};

// The same in space: T_from_to as measured; covariance of its increment (rotation, translation), see pose_motion.h. Along directions that
// nothing was measured of it is as good as infinite.
struct SpatialEdge {
  uint32_t from = 0, to = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
  bool loop = false;  // may be wrong: a robust loss lets it go
};

struct SGraph {
  // Made by a planar laser: walls are seen on one line, in the plane of the keyframes, whose height above the floor is not known; there are
  // no floors and ceilings, and height, roll and pitch of keyframes are conventions.
  bool planar = false;
  std::vector<Keyframe> keyframes;   // ids are stable; merged ones keep their slot, without points
  std::vector<PoseEdge> edges;       // between keyframes, of their levelled frames; by a planar laser: odometry's steps and the loops
  std::vector<SpatialEdge> loops;    // between keyframes, by any other sensor
  std::vector<MapSurface> surfaces;  // ids are stable; merged ones keep their slot, empty or with a part split off another
};

}  // namespace plumb::runtime
