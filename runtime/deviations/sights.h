// What was seen from where: every kept point of the map with the place that the sensor saw it from, in the plan.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>

#include "runtime/mapping/sgraph.h"

namespace plumb::runtime {

// A line of sight, plan frame: nothing opaque stands between the two.
struct Sight {
  Eigen::Vector3d from, to;
  uint32_t keyframe = 0;
  Eigen::Matrix2d smear_m2 = Eigen::Matrix2d::Zero();  // of both, by motion that nobody could take out of the sweep
};

inline constexpr size_t kSightsPerKeyframe = 6000;

// An even sample of each keyframe's points, at most `per_keyframe`, in the map's order. Merged keyframes have none: those they were merged
// into saw the same.
template <class F>
void ForEachSight(const SGraph& map, const Eigen::Isometry3d& T_plan_map, F&& visit,
                  size_t per_keyframe = kSightsPerKeyframe) {
  for (const Keyframe& keyframe : map.keyframes) {
    if (keyframe.merged) continue;
    const Eigen::Isometry3d T = T_plan_map * keyframe.T_map_kf;
    const size_t step = std::max<size_t>(1, (keyframe.points.size() + per_keyframe - 1) / per_keyframe);
    size_t next = 0;
    Sight sight{T.translation(), {}, keyframe.id, keyframe.smear.Rotated(T.linear()).m2.topLeftCorner<2, 2>()};
    for (size_t i = 0; i < keyframe.points.size(); i += step) {
      for (; next < keyframe.standpoints.size() && keyframe.standpoints[next].first_point <= i; ++next) {
        sight.from = T * keyframe.standpoints[next].sensor.cast<double>();
      }
      sight.to = T * keyframe.points[i].cast<double>();
      visit(static_cast<const Sight&>(sight));
    }
  }
}

}  // namespace plumb::runtime
