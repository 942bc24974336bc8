#include "tools/evaluate/evaluate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace plumb::tools {
namespace {

// Without what is not to be compared.
runtime::Trajectory Comparable(runtime::Trajectory trajectory, const EvaluateOptions& options) {
  if (!options.in_plane) return trajectory;
  for (runtime::StampedPose& pose : trajectory) pose.T.translation().z() = 0;
  return trajectory;
}

// Doubles near 1.7e9 s resolve 0.24 us, so stamps that were written by two printers are the same within a microsecond.
long long Microseconds(double stamp_s) { return std::llround(stamp_s * 1e6); }

void CountVerdicts(const std::vector<VerdictRow>& verdicts, Evaluation& out) {
  out.scans = verdicts.size();
  for (const VerdictRow& v : verdicts) {
    if (v.verdict != "localized") continue;
    ++out.localized_scans;
    if (!out.time_to_localize_s) out.time_to_localize_s = v.stamp_s - verdicts.front().stamp_s;
  }
}

void CountWrongFixes(const Run& run, const runtime::Trajectory& truth, const EvaluateOptions& options, Evaluation& out) {
  std::map<long long, bool> localized;
  for (const VerdictRow& v : run.verdicts) localized[Microseconds(v.stamp_s)] = v.verdict == "localized";
  for (const runtime::StampedPose& pose : Comparable(run.online, options)) {
    const auto verdict = localized.find(Microseconds(pose.stamp_s));
    if (verdict != localized.end() && !verdict->second) continue;
    const auto at = runtime::InterpolatePose(truth, pose.stamp_s, options.max_truth_gap_s);
    if (!at) continue;
    const PoseDifference d = Difference(pose.T, *at);
    if (d.distance_m <= options.wrong_fix_m && std::abs(d.yaw_rad) <= options.wrong_fix_rad) continue;
    ++out.wrong_fixes;
    if (!out.first_wrong_fix_s) out.first_wrong_fix_s = pose.stamp_s;
  }
}

}  // namespace

std::string EvaluateOptions::Check() const {
  const auto positive = [](const char* name, double value) {
    return value > 0 && std::isfinite(value) ? std::string()
                                             : fmt::format("EvaluateOptions.{} = {}; must be a positive number", name, value);
  };
  for (const std::string& message : {positive("wrong_fix_m", wrong_fix_m), positive("wrong_fix_rad", wrong_fix_rad),
                                     positive("max_truth_gap_s", max_truth_gap_s), positive("min_points", min_points)}) {
    if (!message.empty()) return message;
  }
  if (!(min_seen_m2 >= 0)) return fmt::format("EvaluateOptions.min_seen_m2 = {}; must be >= 0", min_seen_m2);
  return {};
}

size_t Evaluation::CountWalls(WallOutcome outcome) const {
  return static_cast<size_t>(std::count_if(walls.begin(), walls.end(), [&](const WallResult& w) { return w.outcome == outcome; }));
}

double Evaluation::max_translation_error_m() const {
  double worst = 0;
  for (const WallResult& w : walls) worst = std::max(worst, w.error_translation_m);
  return worst;
}

double Evaluation::max_rotation_error_deg() const {
  double worst = 0;
  for (const WallResult& w : walls) worst = std::max(worst, w.error_rotation_deg);
  return worst;
}

Evaluation Evaluate(const Run& run, const Truth& truth, const EvaluateOptions& options) {
  Evaluation out;
  CountVerdicts(run.verdicts, out);
  out.in_plane = options.in_plane;
  const runtime::Trajectory trajectory = Comparable(truth.trajectory, options);
  CountWrongFixes(run, trajectory, options, out);
  out.online = ComparePoses(Comparable(run.online, options), trajectory, options.max_truth_gap_s);
  out.smoothed = ComparePoses(Comparable(run.smoothed, options), trajectory, options.max_truth_gap_s);
  out.has_walls = truth.has_walls;
  if (!truth.has_walls) return out;
  out.walls = CompareWalls(truth, run.deviations, options.min_points, options.min_seen_m2);
  out.missing = CompareMissing(truth, run.deviations, options.min_points, out.localized_scans > 0);
  out.unplanned = CompareUnplanned(truth, run.deviations, options.min_points, out.localized_scans > 0);
  out.doorways = CompareDoorways(truth, run.deviations, options.min_points, out.localized_scans > 0);
  return out;
}

}  // namespace plumb::tools
