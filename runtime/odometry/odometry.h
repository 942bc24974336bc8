// LiDAR odometry: deskew and point-to-plane registration, in one, against a voxel map of what was seen before.
//
// The poses at a sweep's start and end are estimated together (registration.h), so turning and braking within a sweep are measured, not
// assumed. The map keeps everything up to max_voxels: a robot that comes back is where it was. A scan that passes by the planes that it is
// near, where those before it lay on them, is looked for anew about its prediction and left out if it fits nowhere: in the map, a misplaced
// one would draw the next ones after it (runtime/METHOD.md, Misplaced scans). The first scan levels the frame
// (leveling.h). Recordings of a planar laser, told by their first scan, go through planar/planar_odometry.h instead, which takes the scan
// plane as level.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>

#include "runtime/sources/recording.h"

namespace plumb::runtime {

struct OdometryOptions {
  double voxel_m = 0.5;         // edge of the map's voxels; each keeps Gaussians of the surfaces in it
  double scan_spacing_m = 0.1;  // scans are averaged over this distance before registration, less where few points would be left
  double range_sigma_m = 0.02;  // noise of a single return
  double min_range_m = 0.4, max_range_m = 80.0;
  int max_iterations = 20;
  Eigen::Vector3d up_in_lidar = Eigen::Vector3d::UnitZ();  // away from gravity when the recording starts, to within 35 degrees
  int max_voxels = 120000;                  // of the map; beyond, the voxels unseen for longest are forgotten (about 1 kB each)
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

struct OdometryResult {
  bool ok = false;  // false: pose is a prediction only
  // A second of scans found no place on the map: a new map begins with this one, at a predicted pose. What was mapped before is not tied to
  // it.
  bool restarted = false;
  bool planar = false;  // the sensor is a planar laser
  bool timed = false;   // per-point times were usable; else points are taken to be of the stamp, "deskew off"
  // At the scan's stamp. odom: origin and yaw of the first scan, z up (from floor, ceiling or walls in the first scan, else as it was
  // told).
  Eigen::Isometry3d T_odom_lidar = Eigen::Isometry3d::Identity();
  Scan deskewed;  // finite points in range, in the lidar frame at the scan's stamp; time_s still says when each was fired
  int iterations = 0;
  int num_inliers = 0;
  double rms_m = 0;  // of inlier point-to-plane residuals
  // Planar lasers: covariance of (x, y, yaw) of the motion since the last scan, in the levelled lidar frame of that time.
  Eigen::Matrix3d step_covariance = Eigen::Matrix3d::Zero();
};

class Odometry {
 public:
  explicit Odometry(const OdometryOptions& options = {});
  ~Odometry();

  // Registers the next scan. `given`: pose of the lidar in a given odometry's own frame at (scan start, scan end), used as a prior for the
  // motion; the planes seen decide where they can. A scan without enough points on the map gets the predicted pose.
  struct GivenMotion {
    Eigen::Isometry3d T_start, T_end;
  };
  [[nodiscard]] OdometryResult Register(const Scan& scan, const std::optional<GivenMotion>& given);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumb::runtime
