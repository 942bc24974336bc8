// Voxels of planar patches ("surfels"): what registration aligns scans to, and what plane segmentation grows from.
//
// A voxel may hold several surfels, each with the Gaussian statistics of its points and a normal towards the side it was seen from.
// A point belongs to a surfel only if its sensor stands on that side: the two faces of a thin wall in one voxel never mix.
// Points of no surfel wait, apart by viewing direction, until they span a plane.
//
// The voxel grid is turned against the axes. Walls and floors are mostly parallel to the axes, and one that coincides with a grid plane
// would have its noise cut in halves by it, each half a biased surfel.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "runtime/odometry/voxel_index.h"

namespace plumb::runtime {

struct SurfelMapOptions {
  double voxel_m = 0.5;
  double range_sigma_m = 0.02;    // noise of a single return
  int min_points = 6;             // of a surfel
  double max_rms_m = 0.035;       // points' rms about the plane; beyond this it is no plane
  double min_minor_m = 0.04;      // points' standard deviation across the plane's narrow side; less is a line, or a corner's rounded noise
  double max_normal_sigma_rad = 0.1;
  double max_points = 1000;       // a surfel with so many no longer changes: what was seen first holds, later drift does not move it
  size_t max_voxels = 400000;     // beyond, the voxels unseen for longest are forgotten (about 1 kB each)
};

struct Surfel {
  // Statistics of the points.
  double count = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();  // sum of (p - mean)(p - mean)^T
  Eigen::Vector3d view_sum = Eigen::Vector3d::Zero(); // of unit vectors towards the sensor

  // The plane, if `planar`. Variances along normal, minor, major; minor and major span the plane.
  bool planar = false;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(), minor = Eigen::Vector3d::UnitX(), major = Eigen::Vector3d::UnitY();
  double var_normal_m2 = 0, var_minor_m2 = 0, var_major_m2 = 0;

  uint32_t voxel = 0;
  uint32_t next = VoxelIndex::kNone;  // the voxel's next surfel
  int8_t view_axis = -1;              // while waiting: the axis (+-x, +-y, +-z as 0..5) that it is seen along
  double fitted_count = 0;            // count when the plane was last fitted

  void Add(const Eigen::Vector3d& p, const Eigen::Vector3d& view);
  void Add(const Surfel& other);
  [[nodiscard]] double SignedDistance(const Eigen::Vector3d& p) const { return normal.dot(p - mean); }
  // Variance of the signed distance of a point of the same surface measured at p: its noise and the plane's own uncertainty there.
  [[nodiscard]] double DistanceVariance(const Eigen::Vector3d& p, double range_sigma_m) const;
  // Of the normal's angle in its less certain direction.
  [[nodiscard]] double NormalVariance(double range_sigma_m) const {
    return std::max(var_normal_m2, range_sigma_m * range_sigma_m) / (count * var_minor_m2);
  }
};

class SurfelMap {
 public:
  explicit SurfelMap(const SurfelMapOptions& options = {});

  // Adds a point seen from `sensor`. Planes are fitted by the next EndScan().
  void Insert(const Eigen::Vector3d& p, const Eigen::Vector3d& sensor);
  // Fits the planes of what has grown since the last call; forgets voxels if there are too many.
  void EndScan();

  // The planar surfel nearest to p, of those that face `sensor`, in p's voxel or, with `neighbours`, in the 27 voxels about it. Null: none.
  [[nodiscard]] const Surfel* Nearest(const Eigen::Vector3d& p, const Eigen::Vector3d& sensor, bool neighbours) const;

  // Appends the indices of the planar surfels in the 27 voxels about p, in a fixed order.
  void Around(const Eigen::Vector3d& p, std::vector<uint32_t>* indices) const;

  // In order of creation; planar and waiting ones. Addresses change with every call that is not const.
  [[nodiscard]] const std::vector<Surfel>& surfels() const { return surfels_; }
  [[nodiscard]] size_t num_voxels() const { return heads_.size(); }
  // Position in units of voxels of the turned grid.
  [[nodiscard]] Eigen::Vector3d GridPosition(const Eigen::Vector3d& p) const { return R_grid_ * p; }
  [[nodiscard]] const SurfelMapOptions& options() const { return options_; }

 private:
  uint32_t NewSurfel(uint32_t voxel);
  void FitPlane(uint32_t index);
  void Promote(uint32_t index);
  void Forget();

  SurfelMapOptions options_;
  Eigen::Matrix3d R_grid_;       // rotation times 1 / voxel_m
  VoxelIndex index_;
  std::vector<uint64_t> keys_;   // of each voxel
  std::vector<uint32_t> heads_;  // of each voxel: its first surfel
  std::vector<uint32_t> last_seen_;
  std::vector<Surfel> surfels_;
  std::vector<uint32_t> touched_;  // surfels that grew since EndScan()
  uint32_t scan_ = 0;
};

}  // namespace plumb::runtime
