// What the map says about one wall's deviation while poses and the plan's place are held: the input of seeding and of the E step.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "runtime/coupling/wall_frame.h"
#include "runtime/mapping/plane_view.h"
#include "runtime/optimization/joint_optimizer.h"

namespace plumb::runtime {

// Between walls: what poses add to their own observations.
inline constexpr double kPoseSigma_m = 0.003, kPoseSigma_rad = 0.0015;

struct WallMeasurement {
  WallId wall;
  Eigen::Vector2d deviation;   // (offset_m, yaw_rad), no prior, if there were no range bias; ...
  Eigen::Vector2d bias_gain;   // ... with a bias b it is deviation + b * bias_gain
  Eigen::Matrix2d covariance;  // of this wall's own observations and unknown thickness, and of how well poses tie it to the others
  // What the wall's two faces say about the bias by the thickness they show, as a normal distribution; zero information if one face was
  // seen.
  double own_bias_m = 0, own_bias_information = 0;
  [[nodiscard]] Eigen::Vector2d At(double bias_m) const { return deviation + bias_m * bias_gain; }
};

[[nodiscard]] ViewNoise NoiseOf(const JointOptions& options, const Keyframe& seen_from);
[[nodiscard]] ViewNoise NoiseOf(const JointOptions& options, const Keyframe& seen_from, const Match& match);  // of a wall
[[nodiscard]] ViewNoise NoiseOf(const JointOptions& options);  // of a view from no keyframe in particular

// One per wall that `matches` sees, by wall id. Linear least squares about the planned place (second order in yaw). T_map_kf per keyframe.
[[nodiscard]] std::vector<WallMeasurement> MeasureWalls(const SGraph& map, const AGraph& plan, const std::vector<WallFrame>& frames,
                                                        const std::vector<Match>& matches, const std::vector<Eigen::Isometry3d>& T_map_kf,
                                                        const Eigen::Isometry3d& T_plan_map, const JointOptions& options);

}  // namespace plumb::runtime
