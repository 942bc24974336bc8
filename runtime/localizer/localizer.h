// The whole runtime behind one class: scans in, a verdict and a pose on every scan, deviations at any time.
#pragma once

#include <memory>
#include <optional>

#include "runtime/localizer/graph_estimator.h"
#include "runtime/localizer/localizer_options.h"
#include "runtime/odometry/odometry.h"

namespace plumb::runtime {

struct ScanVerdict {
  double stamp_s = 0;
  Verdict verdict = Verdict::kSearching;
  int hypotheses = 0;
  bool in_order = true;  // else the stamp is not later than an earlier scan's: the scan is left out, and this is about the one before
  bool timed = false;  // per-point times were usable; else "deskew off"
  std::optional<Eigen::Isometry3d> T_plan_lidar;  // at the stamp, from the first fix on; when lost, dead reckoning from the last one
  std::shared_ptr<const MatchTry> last_try;  // the newest, of this scan or an earlier one of the same map
  std::vector<StageTime> timing;
};

// What a given odometry (any start frame) says of the lidar's motion during `scan`; none where it does not cover the sweep.
[[nodiscard]] std::optional<Odometry::GivenMotion> GivenMotionDuring(const Scan& scan, const Trajectory& given_odometry);

// Deterministic, whatever threads the matcher uses: the same scans give the same verdicts, poses and deviations. The steps of AddScan()
// share no state, so that each may run on a thread of its own, as long as every one of them gets the scans in their order (replay.h,
// online_localizer.h).
class Localizer {
 public:
  // `plan` must outlive it; `options` must pass Check().
  Localizer(const AGraph& plan, const LocalizerOptions& options = {});

  // The next scan. One whose stamp is not later than all before it is left out. `given`: see Odometry::Register.
  [[nodiscard]] ScanVerdict AddScan(const Scan& scan, const std::optional<Odometry::GivenMotion>& given);

  // Its steps. Odometry: some milliseconds.
  [[nodiscard]] RegisteredScan Register(const Scan& scan, const std::optional<Odometry::GivenMotion>& given);
  // Map, match, solve: up to seconds. `hold`: see GraphEstimator::Add.
  [[nodiscard]] GraphState UpdateGraph(const RegisteredScan& scan, bool hold = false) { return graph_.Add(scan, hold); }
  // The verdict on a scan, given what the graph knew after it, or after some earlier one. Next to nothing.
  [[nodiscard]] ScanVerdict Track(const RegisteredScan& scan, const GraphState& graph);

  // After the last scan (or whenever asked, with no step running): a final solve over everything.
  void Finish() { graph_.Finish(); }

  // See GraphEstimator::RequestUpdate. From any thread.
  void RequestUpdate() { graph_.RequestUpdate(); }

  // Where the present map lies in the plan; none while it has no place there. A robot that sees nothing for a moment is lost, its map is
  // not.
  [[nodiscard]] std::optional<Eigen::Isometry3d> T_plan_map() const;
  [[nodiscard]] const SGraph& map() const { return graph_.map(); }  // the present one
  [[nodiscard]] const MatchTry* last_try() const { return graph_.last_try(); }  // in the present map; null before the first
  [[nodiscard]] const JointResult& estimate() const { return graph_.estimate(); }
  [[nodiscard]] DeviationReport Deviations() const { return graph_.Deviations(); }
  // Plan frame, with all knowledge so far: all scans that could be registered to the present map, if it lies in the plan, after those of
  // maps that were given up because the robot was carried off (odometry.h: restarted).
  [[nodiscard]] Trajectory SmoothedTrajectory() const;

 private:
  [[nodiscard]] bool blind() const;

  // One step's state each.
  Odometry odometry_;
  int odometry_map_ = 0;
  std::optional<double> last_stamp_s_;
  Eigen::Isometry3d T_odom_last_ = Eigen::Isometry3d::Identity();
  GraphEstimator graph_;
  int failed_scans_ = 0;  // in a row
};

}  // namespace plumb::runtime
