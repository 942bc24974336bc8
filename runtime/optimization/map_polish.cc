#include "runtime/optimization/map_polish.h"

#include "runtime/optimization/joint_problem.h"
#include "schema/agraph.h"

namespace plumb::runtime {

JointOptions PolishOptions() {
  JointOptions options;
  options.edge_m2 = 0;
  options.observation_loss = 1;
  options.max_iterations = 100;
  return options;
}

PolishResult PolishMap(const SGraph& map, const JointOptions& options) {
  PolishResult out;
  for (const Keyframe& keyframe : map.keyframes) out.T_map_kf.push_back(keyframe.T_map_kf);
  if (out.message = options.Check(); !out.message.empty()) return out;
  if (map.keyframes.empty()) {
    out.message = "the map has no keyframes";
    return out;
  }
  const AGraph no_plan;
  const std::vector<WallFrame> no_frames;
  const std::vector<Match> no_matches;
  JointState state;
  for (const Keyframe& keyframe : map.keyframes) state.poses.push_back(PoseBlock(keyframe.T_map_kf));
  state.place = PlaceBlock(Eigen::Isometry3d::Identity());
  JointProblem problem(map, no_plan, no_frames, no_matches, options, state);
  const JointProblem::Outcome outcome = problem.Solve();
  out.usable = outcome.usable;
  out.converged = outcome.converged;
  out.iterations = outcome.iterations;
  out.message = outcome.message;
  if (outcome.usable) out.T_map_kf = Poses(state);
  return out;
}

}  // namespace plumb::runtime
