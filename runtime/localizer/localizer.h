// The whole runtime behind one class: scans in, a verdict and a pose on every scan, deviations at any time.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/coupling/coupling.h"
#include "runtime/deviations/deviations.h"
#include "runtime/mapping/mapper.h"
#include "runtime/matching/matcher.h"
#include "runtime/odometry/odometry.h"
#include "runtime/optimization/joint_optimizer.h"

namespace plumb::runtime {

enum class Verdict : uint8_t { kSearching, kAmbiguous, kLocalized, kLost };
[[nodiscard]] const char* VerdictName(Verdict verdict);  // searching | ambiguous | localized | lost

struct LocalizerOptions {
  int optimize_every = 1;          // keyframes between two joint solves once localized
  int rescore_every = 10;          // keyframes between two re-scorings of the fix against its rivals and against "outside the plan"
  int lost_after = 2;              // as many re-scorings in a row that speak against the fix end it
  double rival_margin_nats = 5.0;  // a rival must be better by this much to count against the fix
  OdometryOptions odometry;
  MapperOptions mapper;
  MatcherOptions matcher;
  CouplingOptions coupling;
  JointOptions joint;
  DeviationOptions deviations;
  [[nodiscard]] std::string Check() const;
};

struct StageTime {
  std::string stage;  // odometry, mapping, matching, optimization
  double ms = 0;
};

struct ScanVerdict {
  double stamp_s = 0;
  Verdict verdict = Verdict::kSearching;
  int hypotheses = 0;
  bool timed = false;  // per-point times were usable; else "deskew off"
  std::optional<Eigen::Isometry3d> T_plan_lidar;  // at the stamp, from the first fix on; when lost, dead reckoning from the last one
  std::vector<StageTime> timing;
};

// What a given odometry (any start frame) says of the lidar's motion during `scan`; none where it does not cover the sweep.
[[nodiscard]] std::optional<Odometry::GivenMotion> GivenMotionDuring(const Scan& scan, const Trajectory& given_odometry);

// Single-threaded and deterministic: the same scans give the same verdicts, poses and deviations.
class Localizer {
 public:
  // `plan` must outlive it; `options` must pass Check().
  Localizer(const AGraph& plan, const LocalizerOptions& options = {});
  ~Localizer();

  // The next scan in time order. `given`: see Odometry::Register.
  [[nodiscard]] ScanVerdict AddScan(const Scan& scan, const std::optional<Odometry::GivenMotion>& given);

  // After the last scan (or whenever asked): a final solve over everything.
  void Finish();

  // Where the map lies in the plan; none while not localized.
  [[nodiscard]] std::optional<Eigen::Isometry3d> T_plan_map() const;
  [[nodiscard]] const SGraph& map() const;  // the present one
  [[nodiscard]] const MatchResult& last_match() const;
  [[nodiscard]] const JointResult& estimate() const;
  [[nodiscard]] DeviationReport Deviations() const;
  // Plan frame, with all knowledge so far: all scans that could be registered to the present map, if it lies in the plan, after those of maps that were given up because the
  // robot was carried off (odometry.h: restarted).
  [[nodiscard]] Trajectory SmoothedTrajectory() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumb::runtime
