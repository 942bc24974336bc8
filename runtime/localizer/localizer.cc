#include "runtime/localizer/localizer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/localizer/stopwatch.h"

namespace plumb::runtime {
namespace {

constexpr int kMaxFailedScans = 3;  // in a row: from then on nobody knows where the robot went meanwhile

}  // namespace

std::string LocalizerOptions::Check() const {
  if (optimize_every < 1) return "LocalizerOptions.optimize_every = " + std::to_string(optimize_every) + "; must be >= 1";
  if (!(solve_all_growth >= 0)) return "LocalizerOptions.solve_all_growth = " + std::to_string(solve_all_growth) + "; must be >= 0";
  if (window_keyframes < 1 || window_keyframes > mapper.recent_keyframes) {
    return "LocalizerOptions.window_keyframes = " + std::to_string(window_keyframes) + "; must be in [1, mapper.recent_keyframes]";
  }
  if (rescore_every < 1) return "LocalizerOptions.rescore_every = " + std::to_string(rescore_every) + "; must be >= 1";
  if (lost_after < 1) return "LocalizerOptions.lost_after = " + std::to_string(lost_after) + "; must be >= 1";
  if (derive_rooms_every < 1) return "LocalizerOptions.derive_rooms_every = " + std::to_string(derive_rooms_every) + "; must be >= 1";
  if (!(rival_margin_nats >= 0)) return "LocalizerOptions.rival_margin_nats = " + std::to_string(rival_margin_nats) + "; must be >= 0";
  for (std::string fault : {odometry.Check(), mapper.Check(), matcher.Check(), graph_matcher.Check(), hint.Check(), coupling.Check(),
                            joint.Check(), deviations.Check()}) {
    if (!fault.empty()) return fault;
  }
  return {};
}

std::optional<Odometry::GivenMotion> GivenMotionDuring(const Scan& scan, const Trajectory& given_odometry) {
  if (given_odometry.empty()) return std::nullopt;
  const double sweep_s = scan.time_s.empty() ? 0.0 : *std::max_element(scan.time_s.begin(), scan.time_s.end());
  const auto start = InterpolatePose(given_odometry, scan.stamp_s);
  const auto end = InterpolatePose(given_odometry, scan.stamp_s + sweep_s);
  if (!start || !end) return std::nullopt;
  return Odometry::GivenMotion{*start, *end};
}

Localizer::Localizer(const AGraph& plan, const LocalizerOptions& options) : odometry_(options.odometry), graph_(plan, options) {}

ScanVerdict Localizer::AddScan(const Scan& scan, const std::optional<Odometry::GivenMotion>& given) {
  const RegisteredScan registered = Register(scan, given);
  return Track(registered, UpdateGraph(registered));
}

RegisteredScan Localizer::Register(const Scan& scan, const std::optional<Odometry::GivenMotion>& given) {
  RegisteredScan out;
  out.stamp_s = scan.stamp_s;
  out.odometry_map = odometry_map_;
  out.odometry.T_odom_lidar = T_odom_last_;
  out.in_order = std::isfinite(scan.stamp_s) && scan.stamp_s > last_stamp_s_.value_or(-std::numeric_limits<double>::infinity());
  if (!out.in_order) return out;
  last_stamp_s_ = scan.stamp_s;
  out.has_points = !scan.points.empty();
  Stopwatch watch;
  out.odometry = odometry_.Register(scan, given);
  out.odometry_ms = watch.Lap();
  odometry_map_ += out.odometry.restarted;
  out.odometry_map = odometry_map_;
  T_odom_last_ = out.odometry.T_odom_lidar;
  return out;
}

bool Localizer::blind() const { return failed_scans_ >= kMaxFailedScans; }

ScanVerdict Localizer::Track(const RegisteredScan& scan, const GraphState& graph) {
  if (scan.in_order) failed_scans_ = scan.odometry.ok || scan.odometry.restarted ? 0 : failed_scans_ + 1;
  ScanVerdict out;
  out.stamp_s = scan.stamp_s;
  out.in_order = scan.in_order;
  out.timed = scan.odometry.timed;
  out.verdict = graph.verdict;
  if (graph.odometry_map != scan.odometry_map) out.verdict = graph.T_plan_odom ? Verdict::kLost : Verdict::kSearching;
  // The map still lies where it did: so does the robot, once it is found in it again.
  if (out.verdict == Verdict::kLocalized && blind()) out.verdict = Verdict::kLost;
  out.hypotheses = out.verdict == Verdict::kLocalized ? 1 : graph.hypotheses;
  out.last_try = graph.last_try;
  if (graph.T_plan_odom) out.T_plan_lidar = *graph.T_plan_odom * scan.odometry.T_odom_lidar;
  out.timing.push_back({"odometry", scan.odometry_ms});
  out.timing.insert(out.timing.end(), graph.timing.begin(), graph.timing.end());
  return out;
}

std::optional<Eigen::Isometry3d> Localizer::T_plan_map() const {
  if (!graph_.placed()) return std::nullopt;
  return graph_.T_plan_map();
}

Trajectory Localizer::SmoothedTrajectory() const {
  Trajectory out = graph_.earlier_poses();
  if (!graph_.placed()) return out;
  const Trajectory poses = graph_.SmoothedPoses();
  out.insert(out.end(), poses.begin(), poses.end());
  return out;
}

}  // namespace plumb::runtime
