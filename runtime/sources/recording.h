// The recording folder: scans/SSSSSSSSSS.NNNNNNNNN.pcd, and optional odometry.tum, truth.tum, truth.json.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "schema/error.h"

namespace plumb::runtime {

// One sweep, structure of arrays. Points in the lidar frame at each point's own firing time; NaN and zero points are dropped.
struct Scan {
  double stamp_s = 0;                   // start of the sweep
  std::vector<Eigen::Vector3f> points;  // metres, lidar frame
  std::vector<float> intensity;         // empty if the source has none
  std::vector<uint16_t> ring;           // empty if the source has none
  std::vector<float> time_s;            // seconds after stamp_s; empty: no per-point time
};

// A pose with its time; T maps the body (lidar) into the trajectory's frame.
struct StampedPose {
  double stamp_s = 0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
};
using Trajectory = std::vector<StampedPose>;  // stamps ascending

// TUM text: `t x y z qx qy qz qw`, # comments; of two poses at one time the later counts.
// Errors: kFileNotFound, kBadTrajectory (line named).
[[nodiscard]] Expected<Trajectory> ReadTum(const std::string& path);
[[nodiscard]] std::string WriteTum(const Trajectory& trajectory);
// Linear in translation, slerp in rotation; none outside the trajectory's span or in gaps above max_gap_s.
[[nodiscard]] std::optional<Eigen::Isometry3d> InterpolatePose(const Trajectory& trajectory, double stamp_s, double max_gap_s = 0.5);

// PCD v0.7, binary, binary_compressed or ascii; fields by name, whatever their type: x y z; intensity; ring; time, t, timestamp
// or offset_time (unit and zero: point_time.h). Safe on hostile files: never allocates more than the file's own size calls for.
// Errors: kFileNotFound, kFileUnreadable, kFileTooLarge (1 GiB), kBadScan. O(points).
[[nodiscard]] Expected<Scan> ReadPcd(const std::string& path, double stamp_s);
// Binary PCD with x y z intensity ring time. Fields that the scan lacks are left out.
[[nodiscard]] Expected<void> WritePcd(const Scan& scan, const std::string& path);

// A recording folder, scans in time order, each read when asked for.
class Recording {
 public:
  // Errors: kNotARecording (no scans/*.pcd), kBadTrajectory. Never opens truth.*.
  [[nodiscard]] static Expected<Recording> Open(const std::string& folder);
  // For those who look for faults: leaves out scans whose names are no stamps, and an odometry that cannot be read, and adds to `faults`
  // what Open fails with. Errors: kNotARecording (no scan with a stamp).
  [[nodiscard]] static Expected<Recording> OpenWithFaults(const std::string& folder, std::vector<Error>& faults);

  [[nodiscard]] size_t size() const { return scan_paths_.size(); }
  [[nodiscard]] double stamp_s(size_t i) const { return stamps_s_[i]; }  // as the file is named
  // Where points come before the stamp, as from drivers that stamp the sweep's end, the scan's stamp is that of its first point.
  [[nodiscard]] Expected<Scan> Read(size_t i) const;
  // Given odometry, any start frame; empty if the recording has none.
  [[nodiscard]] const Trajectory& odometry() const { return odometry_; }

 private:
  std::vector<std::string> scan_paths_;
  std::vector<double> stamps_s_;
  Trajectory odometry_;
};

// "0000000012.300000000.pcd" for 12.3 s.
[[nodiscard]] std::string ScanFileName(double stamp_s);

}  // namespace plumb::runtime
