// LiDAR odometry: deskew, then point-to-plane registration against a voxel map of what was seen before.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>

#include "runtime/sources/recording.h"

namespace plumb::runtime {

struct OdometryOptions {
  double voxel_m = 0.5;             // edge of the map's voxels; each keeps a Gaussian of its points
  double scan_voxel_m = 0.1;        // scans are thinned to one point per voxel before registration
  double min_range_m = 0.4, max_range_m = 80.0;
  int max_iterations = 20;
  [[nodiscard]] std::string Check() const;
};

struct OdometryResult {
  bool ok = false;               // false: pose is a prediction only
  Eigen::Isometry3d T_odom_lidar = Eigen::Isometry3d::Identity();  // at the scan's stamp; odom: z up (gravity from the floor or the first pose)
  Scan deskewed;                 // points in the lidar frame at the scan's stamp; time_s empty
  int iterations = 0;
  int num_inliers = 0;
  double rms_m = 0;              // of inlier point-to-plane residuals
};

class Odometry {
 public:
  explicit Odometry(const OdometryOptions& options = {});
  ~Odometry();

  // Registers the next scan. `given`: pose of the lidar in a given odometry's own frame at (scan start, scan end), used as a prior for the motion.
  struct GivenMotion { Eigen::Isometry3d T_start, T_end; };
  [[nodiscard]] OdometryResult Register(const Scan& scan, const std::optional<GivenMotion>& given);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumb::runtime
