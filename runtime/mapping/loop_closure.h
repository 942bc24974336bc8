// Loop closure of planar scans (3D lidars: spatial_loops.h): finds places that the robot has been at before.
//
// A keyframe's scan is searched for (correlative_search.h) on the scans about an earlier keyframe, in a window that follows from the
// covariance of the one's pose in the other, and refined on their lines. It counts if it explains the scan, and if it is no further from
// the prediction than that covariance allows (chi square, 99.9 %).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/mapping/pose_graph.h"
#include "runtime/odometry/planar/planar_scan.h"

namespace plumb::runtime {

class LoopCloser {
 public:
  // `sigma_m`: of a point about a wall.
  explicit LoopCloser(double sigma_m) : sigma_m_(sigma_m) {}

  // Every scan's pose in odometry's frame, and the covariance of (x, y, yaw) of its motion since the last.
  void Move(const Pose2& T_odom_scan, const Eigen::Matrix3d& step_covariance);
  // A keyframe may begin at the scan of the last Move().
  void Open();
  // The keyframe that began at the last Open() is kept. `poses`: of all keyframes in the map, itself last. True if it closes a loop.
  // O(keyframes log keyframes), plus some milliseconds if there is a place to look at.
  bool Add(PlanarScan scan, const std::vector<Pose2>& poses);

  [[nodiscard]] const std::vector<PoseEdge>& edges() const { return edges_; }

 private:
  struct Keyframe {
    PlanarScan scan;
    Pose2 T_odom_kf;
    double travelled_m = 0;
  };

  [[nodiscard]] std::vector<uint32_t> Candidates(const std::vector<Pose2>& poses) const;
  [[nodiscard]] std::optional<PoseEdge> Match(uint32_t candidate, const std::vector<Pose2>& poses, const Eigen::Matrix3d& covariance) const;

  double sigma_m_;
  std::vector<Keyframe> keyframes_;
  std::vector<PoseEdge> edges_;
  double closed_at_m_ = 0;  // way travelled at the last loop
  // Of odometry: the last scan, the open keyframe, covariance from the last kept keyframe to the open one and from there to the last scan.
  bool moved_ = false, opened_ = false, kept_ = false;
  Pose2 last_, open_;
  double last_travelled_m_ = 0, open_travelled_m_ = 0;
  Eigen::Matrix3d to_open_ = Eigen::Matrix3d::Zero(), since_open_ = Eigen::Matrix3d::Zero();
};

}  // namespace plumb::runtime
