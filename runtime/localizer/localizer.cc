#include "runtime/localizer/localizer.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace plumb::runtime {
namespace {

constexpr int kMaxFailedScans = 10;

// Milliseconds since construction or the last call of Lap.
class Stopwatch {
 public:
  double Lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - start_).count();
    start_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// A registered scan by the keyframe that was the newest when it came: it follows that keyframe through every later solve.
struct ScanPlace {
  double stamp_s = 0;
  uint32_t keyframe = 0;
  Eigen::Isometry3d T_odom_lidar = Eigen::Isometry3d::Identity();
};

}  // namespace

const char* VerdictName(Verdict verdict) {
  switch (verdict) {
    case Verdict::kSearching: return "searching";
    case Verdict::kAmbiguous: return "ambiguous";
    case Verdict::kLocalized: return "localized";
    case Verdict::kLost: return "lost";
  }
  return "searching";
}

std::string LocalizerOptions::Check() const {
  if (optimize_every < 1) return "LocalizerOptions.optimize_every = " + std::to_string(optimize_every) + "; must be >= 1";
  if (rescore_every < 1) return "LocalizerOptions.rescore_every = " + std::to_string(rescore_every) + "; must be >= 1";
  if (lost_after < 1) return "LocalizerOptions.lost_after = " + std::to_string(lost_after) + "; must be >= 1";
  if (!(rival_margin_nats >= 0)) return "LocalizerOptions.rival_margin_nats = " + std::to_string(rival_margin_nats) + "; must be >= 0";
  for (std::string fault : {odometry.Check(), mapper.Check(), matcher.Check(), coupling.Check(), joint.Check(), deviations.Check()}) {
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

struct Localizer::Impl {
  Impl(const AGraph& plan_in, const LocalizerOptions& options_in)
      : plan(plan_in), options(options_in), odometry(options.odometry), mapper(options.mapper), matcher(plan, options.matcher) {
    ForgetFix();
  }

  const AGraph& plan;
  LocalizerOptions options;
  Odometry odometry;
  Mapper mapper;
  Matcher matcher;

  Verdict verdict = Verdict::kSearching;
  MatchResult match;
  JointResult joint;
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();  // of the last fix
  bool ever_fixed = false;
  int failed_scans = 0;  // in a row
  std::vector<WallDeviation> known;  // per plan wall, as estimated so far
  std::vector<Eigen::Isometry3d> rivals;  // of the fix, T_plan_map each
  int votes_against = 0;
  std::vector<ScanPlace> places;

  void ForgetFix() {
    known.assign(plan.walls.size(), {});
    rivals.clear();
    votes_against = 0;
    joint = {};
  }

  // Tries to find the map in the plan. A try that leaves several places open is no fix.
  void Search() {
    match = matcher.Match(mapper.graph());
    switch (match.verdict) {
      case MatchResult::Verdict::kSearching:
        if (verdict != Verdict::kLost) verdict = Verdict::kSearching;
        return;
      case MatchResult::Verdict::kAmbiguous: verdict = Verdict::kAmbiguous; return;
      case MatchResult::Verdict::kUnique: break;
    }
    ForgetFix();
    T_plan_map = match.hypotheses.front().T_plan_map;
    for (size_t i = 1; i < match.hypotheses.size(); ++i) rivals.push_back(match.hypotheses[i].T_plan_map);
    verdict = Verdict::kLocalized;
    ever_fixed = true;
    Optimize(false);
  }

  // Couples map and plan at the current estimate and solves everything jointly. Covariances cost half of the time and steer nothing:
  // they are left out until somebody asks.
  void Optimize(bool covariances) {
    const std::vector<Match> matches = MatchSurfaces(mapper.graph(), plan, T_plan_map, known, options.coupling);
    if (matches.empty()) return;
    JointOptions joint_options = options.joint;
    joint_options.covariances = covariances;
    JointResult result = OptimizeJointly(mapper.graph(), plan, matches, T_plan_map, joint_options);
    if (result.T_map_kf.empty()) return;  // unusable; a solution short of its last digit is not
    joint = std::move(result);
    T_plan_map = joint.T_plan_map;
    for (const WallEstimate& wall : joint.walls) known[wall.wall.index()] = wall.deviation;
    std::vector<Keyframe>& keyframes = mapper.mutable_graph().keyframes;
    for (size_t i = 0; i < keyframes.size() && i < joint.T_map_kf.size(); ++i) keyframes[i].T_map_kf = joint.T_map_kf[i];
    mapper.OnPosesChanged();
  }

  // Does the evidence still speak for the fix? A rival, or "outside the plan", that is better several times in a row ends it.
  void Rescore() {
    const double own = matcher.Score(mapper.graph(), T_plan_map);
    double best_rival = 0;  // "outside the plan"
    for (const Eigen::Isometry3d& T : rivals) best_rival = std::max(best_rival, matcher.Score(mapper.graph(), T));
    votes_against = best_rival > own + options.rival_margin_nats ? votes_against + 1 : 0;
    if (votes_against < options.lost_after) return;
    verdict = Verdict::kLost;
    // The plan has bent the map to a wrong place: back to what odometry says. (Surfaces that were merged meanwhile stay merged.)
    for (Keyframe& keyframe : mapper.mutable_graph().keyframes) keyframe.T_map_kf = keyframe.T_odom_kf;
    mapper.OnPosesChanged();
    ForgetFix();
  }

  // After a new keyframe.
  void UpdateGraph(std::vector<StageTime>& timing) {
    Stopwatch watch;
    const size_t count = mapper.graph().keyframes.size();
    if (verdict != Verdict::kLocalized) {
      Search();
      timing.push_back({"matching", watch.Lap()});
      return;
    }
    if (count % static_cast<size_t>(options.optimize_every) == 0) Optimize(false);
    timing.push_back({"optimization", watch.Lap()});
    if (count % static_cast<size_t>(options.rescore_every) == 0) {
      Rescore();
      timing.push_back({"matching", watch.Lap()});
    }
  }

  void Remember(double stamp_s, const Eigen::Isometry3d& T_odom_lidar) {
    const std::vector<Keyframe>& keyframes = mapper.graph().keyframes;
    places.push_back({stamp_s, keyframes.empty() ? 0 : keyframes.back().id, T_odom_lidar});
  }

  // Scans that registration could not place stay out of the map; after a second of them nobody knows where the robot is.
  void CountFailures(bool ok) {
    failed_scans = ok ? 0 : failed_scans + 1;
    if (failed_scans < kMaxFailedScans || verdict != Verdict::kLocalized) return;
    verdict = Verdict::kLost;
    ForgetFix();
  }
};

Localizer::Localizer(const AGraph& plan, const LocalizerOptions& options) : impl_(std::make_unique<Impl>(plan, options)) {}
Localizer::~Localizer() = default;

ScanVerdict Localizer::AddScan(const Scan& scan, const std::optional<Odometry::GivenMotion>& given) {
  ScanVerdict out;
  out.stamp_s = scan.stamp_s;
  Stopwatch watch;
  const OdometryResult registered = impl_->odometry.Register(scan, given);
  out.timing.push_back({"odometry", watch.Lap()});
  impl_->CountFailures(registered.ok);
  const bool grew = registered.ok && impl_->mapper.AddScan(registered.deskewed, registered.T_odom_lidar);
  out.timing.push_back({"mapping", watch.Lap()});
  if (grew) impl_->UpdateGraph(out.timing);
  impl_->Remember(scan.stamp_s, registered.T_odom_lidar);
  out.verdict = impl_->verdict;
  out.hypotheses = out.verdict == Verdict::kLocalized ? 1 : static_cast<int>(impl_->match.hypotheses.size());
  if (impl_->ever_fixed) {
    out.T_plan_lidar = impl_->T_plan_map * impl_->mapper.T_map_odom() * registered.T_odom_lidar;
  }
  return out;
}

void Localizer::Finish() {
  impl_->mapper.Flush();
  if (impl_->verdict == Verdict::kLocalized) impl_->Optimize(true);
}

std::optional<Eigen::Isometry3d> Localizer::T_plan_map() const {
  if (impl_->verdict != Verdict::kLocalized) return std::nullopt;
  return impl_->T_plan_map;
}

const SGraph& Localizer::map() const { return impl_->mapper.graph(); }
const MatchResult& Localizer::last_match() const { return impl_->match; }
const JointResult& Localizer::estimate() const { return impl_->joint; }
DeviationReport Localizer::Deviations() const { return AssessDeviations(impl_->plan, impl_->joint, impl_->options.deviations); }

Trajectory Localizer::SmoothedTrajectory() const {
  Trajectory out;
  if (impl_->verdict != Verdict::kLocalized) return out;
  const std::vector<Keyframe>& keyframes = impl_->mapper.graph().keyframes;
  out.reserve(impl_->places.size());
  for (const ScanPlace& place : impl_->places) {
    const Keyframe& keyframe = keyframes[place.keyframe];  // there is one: the fix came after it
    out.push_back({place.stamp_s, impl_->T_plan_map * keyframe.T_map_kf * keyframe.T_odom_kf.inverse() * place.T_odom_lidar});
  }
  return out;
}

}  // namespace plumb::runtime
