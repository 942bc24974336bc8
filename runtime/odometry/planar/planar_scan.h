// Scans of planar lasers: one ring, all beams in one plane through the sensor.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "runtime/odometry/planar/pose2.h"
#include "runtime/odometry/scan_preparation.h"
#include "runtime/sources/recording.h"

namespace plumb::runtime {

// Normal of the plane through the sensor in which all beams lie, within 2 degrees, on the side of the sensor's own z axis; none if the scan
// has more than one ring, is not flat, or spans less than 20 degrees. O(points); for scans with many rings far less.
[[nodiscard]] std::optional<Eigen::Vector3d> ScanPlaneNormal(const Scan& scan);

// The scan plane is taken as level: nothing in a planar scan says which way is down. Splits a lidar's pose accordingly.
[[nodiscard]] LeveledPose Leveled(const Eigen::Isometry3d& T_odom_lidar);

struct PlanarPoint {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  // of the line that its neighbours form, towards the sensor; zero: they form none
  double s = 0;                                      // fraction of the sweep at which it was seen
  [[nodiscard]] bool has_normal() const { return normal != Eigen::Vector2d::Zero(); }
};

// Thinned points in the levelled frame at the scan's stamp, by azimuth; the sensor is at the origin.
using PlanarScan = std::vector<PlanarPoint>;

// `motion`: the levelled frame's poses at the sweep's start and end, in any frame. `sigma_m`: of a point about a line. O(points log
// points).
struct PlanarSweep {
  Pose2 start, end;
};
[[nodiscard]] PlanarScan MakePlanarScan(const PreparedScan& prepared, const Eigen::Matrix3d& leveling, const PlanarSweep& motion,
                                        double sigma_m);

}  // namespace plumb::runtime
