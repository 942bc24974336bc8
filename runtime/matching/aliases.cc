#include "runtime/matching/aliases.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace plumb::runtime {
namespace {

// x -> Rz(yaw) x + translation of a pose. The motion is given in the plan frame, the pose in the mesh's.
PlanarPose Moved(const PlanarPose& pose, double yaw_rad, const Eigen::Vector3d& translation, const Eigen::Vector3d& origin) {
  PlanarPose turn;
  turn.yaw_rad = yaw_rad;
  const Eigen::Vector2d t = turn.rotation() * (pose.t_m + origin.head<2>()) + translation.head<2>() - origin.head<2>();
  return {WrapAngle(pose.yaw_rad + yaw_rad), t, pose.z_m + translation.z()};
}

// A half turn is its own inverse.
bool IsInvolution(const Alias& alias) {
  constexpr double kHalfTurn_rad = 0.01, kSameHeight_m = 0.01;
  return std::abs(alias.yaw_rad) > std::numbers::pi - kHalfTurn_rad && std::abs(alias.translation.z()) < kSameHeight_m;
}

}  // namespace

std::vector<PlanarPose> AliasedPoses(const AGraph& plan, const PlanarPose& pose) {
  std::vector<PlanarPose> poses;
  for (const Alias& alias : plan.aliases) {
    poses.push_back(Moved(pose, alias.yaw_rad, alias.translation, plan.origin));
    if (IsInvolution(alias)) continue;
    const Eigen::AngleAxisd back(-alias.yaw_rad, Eigen::Vector3d::UnitZ());
    poses.push_back(Moved(pose, -alias.yaw_rad, -(back * alias.translation), plan.origin));
  }
  return poses;
}

}  // namespace plumb::runtime
