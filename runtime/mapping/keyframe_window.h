// The scans between two keyframes, gathered in the first one's frame.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "runtime/mapping/mapper_options.h"
#include "runtime/mapping/sgraph.h"
#include "runtime/odometry/surfel_map.h"
#include "runtime/sources/recording.h"

namespace plumb::runtime {

// What one scan saw.
struct View {
  Eigen::Vector3d sensor = Eigen::Vector3d::Zero();  // keyframe frame
  std::vector<Eigen::Vector3f> points;               // keyframe frame, in the order of time
  std::vector<Keyframe::Standpoint> standpoints;     // where it was meanwhile
};

struct ThinnedPoints {
  std::vector<Eigen::Vector3f> points;  // keyframe frame
  std::vector<Keyframe::Standpoint> standpoints;
};

class KeyframeWindow {
 public:
  // Opens at the lidar's pose T_odom_kf, which becomes the keyframe's.
  KeyframeWindow(const MapperOptions& options, double stamp_s, const Eigen::Isometry3d& T_odom_kf);

  // `planar`: of a planar laser, whose scans make no surfels. `smear`: in the lidar's axes. `velocity_m_s`: of the sensor during the sweep,
  // in the axes of odom.
  void Add(const Scan& deskewed, const Eigen::Isometry3d& T_odom_lidar, bool planar, const Smear& smear = {},
           const Eigen::Vector3d& velocity_m_s = Eigen::Vector3d::Zero());

  [[nodiscard]] double stamp_s() const { return stamp_s_; }
  [[nodiscard]] const Eigen::Isometry3d& T_odom_kf() const { return T_odom_kf_; }
  [[nodiscard]] const std::vector<View>& views() const { return views_; }
  [[nodiscard]] const SurfelMap& surfels() const { return surfels_; }

  [[nodiscard]] bool planar() const { return planar_; }
  [[nodiscard]] const Smear& smear() const { return smear_; }  // covers its scans'

  // At most one point per voxel and max_keyframe_points.
  [[nodiscard]] ThinnedPoints Thinned() const;

 private:
  MapperOptions options_;
  double stamp_s_;
  Eigen::Isometry3d T_odom_kf_;
  std::vector<View> views_;
  size_t num_points_ = 0;
  SurfelMap surfels_;
  bool planar_ = false;
  Smear smear_;
};

}  // namespace plumb::runtime
