#include "tools/evaluate/pose_errors.h"

#include <algorithm>
#include <cmath>

namespace plumb::tools {

PoseDifference Difference(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth) {
  PoseDifference out;
  out.distance_m = (estimate.translation() - truth.translation()).norm();
  // Yaw of the rotation from truth to estimate, seen in the plan: no Euler angles of either pose, so no wrap-around between them.
  const Eigen::Matrix3d R = estimate.linear() * truth.linear().transpose();
  out.yaw_rad = std::atan2(R(1, 0) - R(0, 1), R(0, 0) + R(1, 1));
  out.tilt_rad = std::atan2(std::hypot(R(0, 2), R(1, 2)), R(2, 2));
  return out;
}

PoseErrors ComparePoses(const runtime::Trajectory& estimate, const runtime::Trajectory& truth, double max_gap_s) {
  PoseErrors out;
  double sum_m = 0, sum_m2 = 0, sum_yaw2 = 0, sum_tilt2 = 0;
  for (const runtime::StampedPose& pose : estimate) {
    const auto at = runtime::InterpolatePose(truth, pose.stamp_s, max_gap_s);
    if (!at) {
      ++out.without_truth;
      continue;
    }
    const PoseDifference d = Difference(pose.T, *at);
    ++out.count;
    sum_m += d.distance_m;
    sum_m2 += d.distance_m * d.distance_m;
    sum_yaw2 += d.yaw_rad * d.yaw_rad;
    sum_tilt2 += d.tilt_rad * d.tilt_rad;
    out.max_m = std::max(out.max_m, d.distance_m);
    out.yaw_max_rad = std::max(out.yaw_max_rad, std::abs(d.yaw_rad));
    out.tilt_max_rad = std::max(out.tilt_max_rad, d.tilt_rad);
  }
  if (out.count == 0) return out;
  const auto n = static_cast<double>(out.count);
  out.mean_m = sum_m / n;
  out.rmse_m = std::sqrt(sum_m2 / n);
  out.yaw_rmse_rad = std::sqrt(sum_yaw2 / n);
  out.tilt_rmse_rad = std::sqrt(sum_tilt2 / n);
  return out;
}

}  // namespace plumb::tools
