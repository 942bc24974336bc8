// Where a map that was found lies in the plan and how every wall deviates, solved over the whole map. Internal to localizer/.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/deviations/deviations.h"
#include "runtime/localizer/localizer_options.h"
#include "runtime/mapping/mapper.h"
#include "runtime/optimization/joint_optimizer.h"

namespace plumb::runtime {

// Matches of surfaces that the map has split since: both parts have them, without what was mistaken of the whole; in the order of surfaces.
void FollowSplits(const std::vector<SurfaceSplit>& splits, std::vector<Match>* matches);

// A value: to know what the end would be, judge a copy of it, on a copy of the map. Deterministic.
class PlanEstimate {
 public:
  // `plan` and `options` must outlive it and its copies.
  PlanEstimate(const AGraph& plan, const LocalizerOptions& options) : plan_(&plan), options_(&options) { Forget(); }

  // Of a map that the matcher found there. `prior`: the place is as good as rays tell it, to decimetres.
  void Begin(const Eigen::Isometry3d& T_plan_map, bool prior);
  // Where rays have the map now: known from more than its walls, as after Begin() with a prior. joint() stays that of the last solve.
  void Lay(const Eigen::Isometry3d& T_plan_map) { T_found_ = T_plan_map_ = T_plan_map; }
  // All but where the map lies.
  void Forget();
  // From now on the map's frame is that of odometry; poses go on from where they are.
  void Hold(const Eigen::Isometry3d& T_map_odom) { T_plan_map_ = T_plan_map_ * T_map_odom; }

  // Couples map and plan at the present estimate, solves everything jointly and writes the poses into the map. False, and nothing
  // changed, if that fails. `covariances` cost half of the time and steer nothing.
  bool Optimize(Mapper& mapper, bool covariances) { return Solve(mapper, covariances, false); }
  // The last word: with covariances, without the walls that are not there and without what is something else that the plan has.
  void OptimizeFinally(Mapper& mapper);
  // From all points of the map, which takes as long as a solve.
  void JudgeDoorways(const SGraph& map);

  [[nodiscard]] JointOptions SolverOptions(const SGraph& map) const;
  [[nodiscard]] const Eigen::Isometry3d& T_plan_map() const { return T_plan_map_; }
  [[nodiscard]] const JointResult& joint() const { return joint_; }
  [[nodiscard]] const WallChanges& changes() const { return changes_; }  // as last judged

 private:
  // `judging`: with all that the last word on walls rests on; then what the new poses split is solved for anew.
  bool Solve(Mapper& mapper, bool covariances, bool judging);
  bool SolveOnce(Mapper& mapper, bool covariances, bool judging, std::vector<SurfaceSplit>* splits);
  void FindOtherShapes(const SGraph& map);
  [[nodiscard]] WallId WallOf(const Match& match) const { return plan_->surfaces[match.plan_surface.index()].wall; }

  const AGraph* plan_;
  const LocalizerOptions* options_;
  Eigen::Isometry3d T_plan_map_ = Eigen::Isometry3d::Identity();  // of the last fix
  std::optional<Eigen::Isometry3d> T_found_;                      // as the matcher's rays have it
  JointResult joint_;
  std::vector<Match> matches_;        // that `joint_` is based on, by the surfaces that the map has since
  std::vector<WallDeviation> known_;  // per plan wall, as estimated so far
  WallChanges changes_;
  std::set<std::pair<uint32_t, WallId>> other_shapes_;  // map surfaces that are something else of the plan than this wall
};

}  // namespace plumb::runtime
