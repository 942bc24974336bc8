#include "tools/plumb/as_built_cloud.h"

#include <cstdint>
#include <unordered_set>

namespace plumb::tools {
namespace {

struct Voxel {
  int64_t x = 0, y = 0, z = 0;
  friend bool operator==(const Voxel&, const Voxel&) = default;
};
struct VoxelHash {
  size_t operator()(const Voxel& v) const noexcept {
    return static_cast<size_t>(v.x) * 73856093u ^ static_cast<size_t>(v.y) * 19349663u ^ static_cast<size_t>(v.z) * 83492791u;
  }
};

}  // namespace

std::vector<Eigen::Vector3d> AsBuiltCloud(const runtime::Localizer& localizer, double voxel_m) {
  std::vector<Eigen::Vector3d> cloud;
  const Eigen::Isometry3d T_plan_map = localizer.T_plan_map().value_or(Eigen::Isometry3d::Identity());
  std::unordered_set<Voxel, VoxelHash> taken;
  for (const runtime::Keyframe& keyframe : localizer.map().keyframes) {
    const Eigen::Isometry3d T_plan_kf = T_plan_map * keyframe.T_map_kf;
    for (const Eigen::Vector3f& point : keyframe.points) {
      const Eigen::Vector3d p = T_plan_kf * point.cast<double>();
      const Eigen::Vector3d cell = (p / voxel_m).array().floor();
      const Voxel voxel{static_cast<int64_t>(cell.x()), static_cast<int64_t>(cell.y()), static_cast<int64_t>(cell.z())};
      if (taken.insert(voxel).second) cloud.push_back(p);
    }
  }
  return cloud;
}

}  // namespace plumb::tools
