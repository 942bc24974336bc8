// From a raw scan to the points that registration uses.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "runtime/odometry/se3.h"
#include "runtime/sources/recording.h"

namespace plumb::runtime {

// The lidar's poses at a sweep's start and end, in the odometry's frame.
struct SweepMotion {
  Eigen::Isometry3d T_start = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_end = Eigen::Isometry3d::Identity();
};

// Poses over a sweep at evenly spaced fractions of it, so that moving a point to the odometry's frame costs no trigonometry.
class SweepPoses {
 public:
  explicit SweepPoses(const SweepMotion& motion);
  // Where the point seen at fraction s in [0, 1] of the sweep, given in the lidar frame at that time, is in the frame of the poses.
  [[nodiscard]] Eigen::Vector3d Apply(const Eigen::Vector3d& p, double s) const {
    const auto [k, w] = Knot(s);
    return (1 - w) * (T_[k] * p) + w * (T_[k + 1] * p);
  }
  // The lidar's position at fraction s.
  [[nodiscard]] Eigen::Vector3d Position(double s) const {
    const auto [k, w] = Knot(s);
    return (1 - w) * T_[k].translation() + w * T_[k + 1].translation();
  }

 private:
  static constexpr int kKnots = 32;
  struct At {
    int k;
    double w;
  };
  [[nodiscard]] static At Knot(double s) {
    const double x = s * kKnots;
    const int k = std::min(static_cast<int>(x), kKnots - 1);
    return {k, x - k};
  }
  Eigen::Isometry3d T_[kKnots + 1];
};

struct SweepPoint {
  Eigen::Vector3d p;  // lidar frame at the time of firing
  double s = 0;       // fraction of the sweep at which it was fired, in [0, 1]
  double count = 1;   // of the returns that it is the mean of
};

struct PreparedScan {
  Scan scan;                       // the points that are finite and in range; otherwise as given
  double sweep_s = 0;              // duration of the sweep; 0: no usable times, all points belong to the stamp
  std::vector<SweepPoint> points;  // thinned

  [[nodiscard]] double Fraction(size_t i) const { return sweep_s > 0 ? std::clamp(scan.time_s[i] / sweep_s, 0.0, 1.0) : 0.0; }
};

// Drops what is not finite or out of range and thins to one point per patch of the sphere about the sensor that is spacing_m wide at the
// point's range. Thinning by direction, not by voxels, because range noise must not decide which points stay: of a voxel that holds only
// the tail of a wall's noise, one point would stay as of any other, and the wall would be biased. A patch's point is the mean of those
// returns whose range is within `mean_depth_m` of it and that were fired at about the same time, which scans without times do not tell; 0:
// its first return. O(points).
[[nodiscard]] PreparedScan PrepareScan(const Scan& scan, double spacing_m, double min_range_m, double max_range_m, double mean_depth_m = 0);

// All points moved to the lidar frame at the sweep's start. They keep the times at which they were fired.
[[nodiscard]] Scan Deskew(const PreparedScan& prepared, const SweepMotion& motion);

}  // namespace plumb::runtime
