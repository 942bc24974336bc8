#include "runtime/localizer/localizer.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace plumb::runtime {
namespace {

constexpr int kMaxFailedScans = 3;  // in a row: from then on nobody knows where the robot went meanwhile

// Walls seen while the robot turned are bent by motion that could not be taken out: by some centimetres and degrees.
constexpr double kUntimedShare = 0.1, kUntimedFloor_m = 0.05, kUntimedFloor_rad = 0.05;

constexpr double kPlanarPlaceSigma_m = 0.05;  // of a planar map's place by its rays

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
  Eigen::Isometry3d T_by_rays = Eigen::Isometry3d::Identity();  // as the matcher found it
  bool ever_fixed = false;
  bool is_placed = false;  // T_plan_map is where the present map lies, even while nobody knows where in it the robot is
  int failed_scans = 0;  // in a row
  size_t num_scans = 0, num_untimed = 0;  // with points
  std::vector<WallDeviation> known;  // per plan wall, as estimated so far
  std::vector<Eigen::Isometry3d> rivals;  // of the fix, T_plan_map each
  int votes_against = 0;
  std::vector<ScanPlace> places;
  // Of maps that were given up while they lay in the plan.
  Trajectory earlier_poses;
  std::vector<SurfaceDeviation> earlier_surfaces;
  std::vector<RoomDeviation> earlier_rooms;

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
    T_plan_map = T_by_rays = match.hypotheses.front().T_plan_map;
    for (size_t i = 1; i < match.hypotheses.size(); ++i) rivals.push_back(match.hypotheses[i].T_plan_map);
    verdict = Verdict::kLocalized;
    ever_fixed = is_placed = true;
    Optimize(false);
  }

  // Couples map and plan at the current estimate and solves everything jointly. Covariances cost half of the time and steer nothing:
  // they are left out until somebody asks.
  void Optimize(bool covariances) {
    const std::vector<Match> matches = MatchSurfaces(mapper.graph(), plan, T_plan_map, known, options.coupling);
    if (matches.empty()) return;
    JointOptions joint_options = options.joint;
    joint_options.covariances = covariances;
    // Half of the walls that a planar laser sees are furniture, which may agree with each other better than with the walls. The rays know.
    if (mapper.graph().planar) {
      joint_options.place = T_by_rays;
      joint_options.place_sigma_m = kPlanarPlaceSigma_m;
    }
    if (num_untimed > kUntimedShare * static_cast<double>(num_scans)) {
      joint_options.observation_floor_m = std::max(joint_options.observation_floor_m, kUntimedFloor_m);
      joint_options.observation_floor_rad = std::max(joint_options.observation_floor_rad, kUntimedFloor_rad);
    }
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
    is_placed = false;
    HoldPose();
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

  // Scans that registration could not place stay out of the map, which still lies where it did: so does the robot, once it is found in it again.
  void CountFailures(bool ok) {
    failed_scans = ok ? 0 : failed_scans + 1;
    if (verdict == Verdict::kLocalized && failed_scans >= kMaxFailedScans) verdict = Verdict::kLost;
    if (verdict == Verdict::kLost && is_placed && ok) verdict = Verdict::kLocalized;
  }

  // From now on the pose is odometry's, going on from where it is.
  void HoldPose() { T_plan_map = T_plan_map * mapper.T_map_odom(); }

  // Odometry has begun a new map: what is seen now is not tied to what was seen before, so neither must the graph be.
  void StartOver() {
    if (is_placed) Archive();
    is_placed = false;
    HoldPose();
    mapper = Mapper(options.mapper);
    places.clear();
    match = {};
    verdict = ever_fixed ? Verdict::kLost : Verdict::kSearching;
    ForgetFix();
  }

  // Keeps what a map that lies in the plan has to say, before it is given up.
  void Archive() {
    mapper.Flush();
    Optimize(true);
    const Trajectory poses = SmoothedPoses();
    earlier_poses.insert(earlier_poses.end(), poses.begin(), poses.end());
    DeviationReport report = Deviations();
    earlier_surfaces = std::move(report.surfaces);
    earlier_rooms = std::move(report.rooms);
  }

  [[nodiscard]] Trajectory SmoothedPoses() const {
    Trajectory out;
    out.reserve(places.size());
    const std::vector<Keyframe>& keyframes = mapper.graph().keyframes;
    for (const ScanPlace& place : places) {
      const Keyframe& keyframe = keyframes[place.keyframe];  // there is one: the fix came after it
      out.push_back({place.stamp_s, T_plan_map * keyframe.T_map_kf * keyframe.T_odom_kf.inverse() * place.T_odom_lidar});
    }
    return out;
  }

  // What only an earlier map saw is as that one saw it.
  [[nodiscard]] DeviationReport Deviations() const {
    DeviationReport report = AssessDeviations(plan, joint, options.deviations);
    for (size_t i = 0; i < earlier_surfaces.size(); ++i) {
      if (report.surfaces[i].status == SurfaceStatus::kUnobserved) report.surfaces[i] = earlier_surfaces[i];
    }
    for (size_t i = 0; i < earlier_rooms.size(); ++i) {
      if (report.rooms[i].status == SurfaceStatus::kUnobserved) report.rooms[i] = earlier_rooms[i];
    }
    return report;
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
  out.timed = registered.timed;
  if (!scan.points.empty()) {
    ++impl_->num_scans;
    impl_->num_untimed += !registered.timed;
  }
  if (registered.restarted) impl_->StartOver();
  impl_->CountFailures(registered.ok || registered.restarted);
  impl_->mapper.HoldPoses(impl_->verdict == Verdict::kLocalized);
  const bool grew = (registered.ok || registered.restarted) &&
                    impl_->mapper.AddScan(registered.deskewed, registered.T_odom_lidar,
                                          registered.planar ? std::optional(registered.step_covariance) : std::nullopt);
  out.timing.push_back({"mapping", watch.Lap()});
  if (grew) impl_->UpdateGraph(out.timing);
  if (registered.ok || registered.restarted) impl_->Remember(scan.stamp_s, registered.T_odom_lidar);
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
DeviationReport Localizer::Deviations() const { return impl_->Deviations(); }

Trajectory Localizer::SmoothedTrajectory() const {
  Trajectory out = impl_->earlier_poses;
  if (impl_->verdict != Verdict::kLocalized) return out;
  const Trajectory poses = impl_->SmoothedPoses();
  out.insert(out.end(), poses.begin(), poses.end());
  return out;
}

}  // namespace plumb::runtime
