#include "runtime/mapping/glimpses.h"

#include <algorithm>

namespace plumb::runtime {
namespace {

constexpr double kSureLength_m = 1.0;  // a longer one is a wall
constexpr int kMinMissed = 2;          // keyframes that should have seen it

}  // namespace

bool IsGlimpse(const MapSurface& surface, const Eigen::Vector3d& at, const std::vector<Keyframe>& keyframes) {
  if (surface.kind != SurfaceKind::kWall || surface.observations.size() != 1 || surface.length_m() >= kSureLength_m) return false;
  const uint32_t seen_by = surface.observations.front().keyframe;
  const auto way = [&](const Keyframe& keyframe) -> Eigen::Vector3d { return keyframe.T_map_kf.translation() - at; };
  const Eigen::Vector3d seen = way(keyframes[seen_by]);
  const double seen_m = seen.norm(), seen_cos = surface.plane.n.dot(seen) / seen_m;
  return std::count_if(keyframes.begin(), keyframes.end(), [&](const Keyframe& keyframe) {
           const Eigen::Vector3d from = way(keyframe);
           const double from_m = from.norm();
           return !keyframe.merged && keyframe.id != seen_by && from_m <= seen_m && surface.plane.n.dot(from) >= seen_cos * from_m;
         }) >= kMinMissed;
}

}  // namespace plumb::runtime
