// What takes registered scans as its input and may take its time: the map, where it lies in the plan, and how every wall deviates.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/deviations/deviations.h"
#include "runtime/localizer/estimate_update.h"
#include "runtime/localizer/localizer_options.h"
#include "runtime/mapping/sgraph.h"
#include "runtime/matching/guidance.h"
#include "runtime/matching/matcher.h"
#include "runtime/optimization/joint_optimizer.h"

namespace plumb::runtime {

struct StageTime {
  std::string stage;  // odometry, mapping, matching, optimization
  double ms = 0;
};

// A scan as odometry hands it on.
struct RegisteredScan {
  double stamp_s = 0;
  bool in_order = true;     // else its stamp is not later than an earlier scan's, and nothing was done with it
  bool has_points = false;  // as it was read
  int odometry_map = 0;     // how many maps odometry had given up by then (OdometryResult::restarted)
  OdometryResult odometry;
  double odometry_ms = 0;

  // Without its points, only where it was taken.
  void Strip() { odometry.deskewed = {odometry.deskewed.stamp_s, {}, {}, {}, {}}; }
};

// A try to find the map in the plan, and where the robot was in the map by then.
struct MatchTry {
  double stamp_s = 0;
  Eigen::Isometry3d T_map_lidar = Eigen::Isometry3d::Identity();
  MatchResult result;
  std::optional<Guidance> guidance;  // what would tell the places apart that it leaves open
};

// What the graph knew after one scan: enough to turn poses in odometry's frame into poses in the plan.
struct GraphState {
  Verdict verdict = Verdict::kSearching;
  int hypotheses = 0;
  int odometry_map = 0;  // of the scan
  // From the first fix on; when lost, so that poses go on from where they were.
  std::optional<Eigen::Isometry3d> T_plan_odom;
  std::shared_ptr<const MatchTry> last_try;  // the newest in this map; null before the first
  bool solve_held = false;                   // the scan closed a keyframe, which was mapped and neither matched nor solved
  std::vector<StageTime> timing;             // of this scan
};

// Deterministic, whatever threads the matcher uses.
class GraphEstimator {
 public:
  // `plan` must outlive it; `options` must pass Check().
  GraphEstimator(const AGraph& plan, const LocalizerOptions& options);
  ~GraphEstimator();

  // The next scan in time order. `hold`: map only; matching and solving, which cost most, wait for the first keyframe added without it, or
  // for the tenth.
  [[nodiscard]] GraphState Add(const RegisteredScan& scan, bool hold);
  // A final solve over everything, with covariances.
  void Finish();
  // LocalizerOptions::on_update is called at the end of the next Add(), with covariances; nothing else changes by it. From any thread.
  void RequestUpdate();

  [[nodiscard]] bool placed() const;  // the present map lies in the plan
  [[nodiscard]] Eigen::Isometry3d T_plan_map() const;
  [[nodiscard]] const SGraph& map() const;
  [[nodiscard]] const MatchTry* last_try() const;  // in the present map; null before the first
  [[nodiscard]] const JointResult& estimate() const;
  // What only an earlier map saw is as that one saw it.
  [[nodiscard]] DeviationReport Deviations() const;
  // Plan frame: of the scans registered to the present map, which must be placed; and to earlier ones, given up since.
  [[nodiscard]] Trajectory SmoothedPoses() const;
  [[nodiscard]] const Trajectory& earlier_poses() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumb::runtime
