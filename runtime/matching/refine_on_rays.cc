#include "runtime/matching/refine_on_rays.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "runtime/matching/ray_likelihood.h"

namespace plumb::runtime {
namespace {

constexpr size_t kRays = 1000;
constexpr double kSteps_m[] = {0.1, 0.05, 0.025};
constexpr double kRadPerMetre = 0.175;  // steps in yaw: 1 degree for 0.1 m
constexpr int kMaxMoves = 5;            // at one step

class RayPosterior {
 public:
  RayPosterior(const PlanIndex& plan, const MapView& map, const WallFit& fit, const MatcherOptions& options)
      : plan_(plan), map_(map), fit_(fit), options_(options), stride_(std::max<size_t>(1, map.rays.size() / kRays)) {}

  [[nodiscard]] double At(const PlanarPose& pose) const {
    const double by_rays = JudgeRays(plan_, map_, pose, options_, stride_).log_likelihood;
    if (map_.planar) return by_rays;
    const Eigen::Vector2d shift_m = pose.t_m - fit_.pose.t_m;
    const Eigen::Vector3d off(shift_m.x(), shift_m.y(), WrapAngle(pose.yaw_rad - fit_.pose.yaw_rad));
    return by_rays - 0.5 * off.dot(fit_.information * off);
  }

 private:
  const PlanIndex& plan_;
  const MapView& map_;
  const WallFit& fit_;
  const MatcherOptions& options_;
  size_t stride_;
};

// One step either way in each of x, y and yaw.
std::array<PlanarPose, 6> Neighbours(const PlanarPose& pose, double step_m) {
  std::array<PlanarPose, 6> out;
  out.fill(pose);
  for (size_t i = 0; i < 2; ++i) {
    const double step = i == 0 ? step_m : -step_m;
    out[i].t_m.x() += step;
    out[2 + i].t_m.y() += step;
    out[4 + i].yaw_rad = WrapAngle(pose.yaw_rad + kRadPerMetre * step);
  }
  return out;
}

}  // namespace

PlanarPose RefineOnRays(const PlanIndex& plan, const MapView& map, const WallFit& fit, const MatcherOptions& options) {
  const RayPosterior posterior(plan, map, fit, options);
  PlanarPose best = fit.pose;
  double highest = posterior.At(best);
  for (const double step_m : kSteps_m) {
    for (int move = 0; move < kMaxMoves; ++move) {
      const std::array<PlanarPose, 6> poses = Neighbours(best, step_m);
      std::array<double, 6> values;
      oneapi::tbb::parallel_for(size_t{0}, poses.size(), [&](size_t i) { values[i] = posterior.At(poses[i]); });
      const auto top = std::max_element(values.begin(), values.end());
      if (*top <= highest) break;
      highest = *top;
      best = poses[static_cast<size_t>(top - values.begin())];
    }
  }
  return best;
}

}  // namespace plumb::runtime
