// Which walls deviate, stand as planned, or cannot be judged, and why not. Internal to deviations/.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "runtime/coupling/wall_frame.h"
#include "runtime/deviations/deviations.h"

namespace plumb::runtime {

struct WallVerdict {
  SurfaceStatus status = SurfaceStatus::kUnobserved;  // kAsPlanned | kDeviated | kUnobserved
  Unjudged unjudged = Unjudged::kNotSeen;             // kNone unless unobserved
};

// Per wall of the estimate, by the rules of AssessDeviations(). `frames`: WallFrames(plan).
[[nodiscard]] std::vector<WallVerdict> JudgeWalls(const AGraph& plan, const std::vector<WallFrame>& frames, const JointResult& estimate,
                                                  const DeviationOptions& options);

// Of what the test sees of a wall's displacement offset_m + gain.y() * yaw_rad, gain.x() being 1.
[[nodiscard]] double TestVariance_m2(const WallEstimate& wall, const Eigen::Vector2d& gain, const DeviationOptions& options);
// Of a displacement with that variance (alpha 0.1 %, power 80 %, one degree of freedom).
[[nodiscard]] double MinimalDetectable_m(double variance_m2);

}  // namespace plumb::runtime
