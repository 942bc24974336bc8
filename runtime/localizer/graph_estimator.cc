#include "runtime/localizer/graph_estimator.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include "runtime/localizer/plan_estimate.h"
#include "runtime/localizer/stopwatch.h"
#include "runtime/mapping/mapper.h"
#include "runtime/matching/graph/graph_search.h"
#include "runtime/optimization/map_polish.h"
#include "runtime/optimization/window_optimizer.h"

namespace plumb::runtime {
namespace {

constexpr double kDoorwayGrowth = 1.25;  // of the map, between two updates that judge doorways
constexpr int kMaxHeld = 10;             // keyframes in a row: a robot that nobody looks for is never found

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

struct GraphEstimator::Impl {
  Impl(const AGraph& plan_in, const LocalizerOptions& options_in)
      : plan(plan_in), options(options_in), mapper(options.mapper), matcher(plan, options.matcher), estimate(plan, options) {
    if (options.matcher_kind == MatcherKind::kGraph) graph_search.emplace(plan, options.graph_matcher);
  }

  const AGraph& plan;
  LocalizerOptions options;
  Mapper mapper;
  Matcher matcher;
  std::optional<GraphSearch> graph_search;  // where rooms are to find the map instead of walls

  Verdict verdict = Verdict::kSearching;
  std::shared_ptr<const MatchTry> last_try;  // of the present map
  PlanEstimate estimate;                     // of the last fix
  bool ever_fixed = false;
  int odometry_map = 0;
  size_t num_keyframes = 0;       // made of the present map so far, ...
  size_t solved_all_at = 0;       // ... and when everything was last solved
  size_t doorways_judged_at = 0;  // ... and when doorways last were, for an update
  bool solve_due = false, rescore_due = false;
  int num_held = 0;                       // keyframes in a row that were only mapped
  std::vector<Eigen::Isometry3d> rivals;  // of the fix, T_plan_map each
  int votes_against = 0;
  std::vector<ScanPlace> places;
  // Of maps that were given up while they lay in the plan.
  Trajectory earlier_poses;
  std::vector<SurfaceDeviation> earlier_surfaces;
  std::vector<RoomDeviation> earlier_rooms;
  std::vector<UnplannedWall> earlier_unplanned;
  std::vector<DoorwayDeviation> earlier_doorways;
  bool news = false;  // solved since the last update
  Verdict told_verdict = Verdict::kSearching;
  std::atomic<bool> update_requested = false;

  [[nodiscard]] bool placed() const { return verdict == Verdict::kLocalized; }

  void ForgetFix() {
    estimate.Forget();
    rivals.clear();
    votes_against = 0;
    solve_due = rescore_due = false;
  }

  // Tries to find the map in the plan. A try that leaves several places open is no fix.
  void Search(double stamp_s, const Eigen::Isometry3d& T_odom_lidar) {
    if (graph_search && num_keyframes % static_cast<size_t>(options.derive_rooms_every) != 0) return;
    const auto match_now = [&] {
      if (graph_search) return graph_search->Match(mapper.graph());
      return matcher.Match(mapper.graph(), odometry_map == 0 ? options.hint : StartHint());
    };
    MatchTry attempt{stamp_s, mapper.T_map_odom() * T_odom_lidar, match_now(), std::nullopt};
    if (!graph_search) attempt.guidance = matcher.Guide(mapper.graph(), attempt.result, attempt.T_map_lidar);
    last_try = std::make_shared<const MatchTry>(std::move(attempt));
    const MatchResult& match = last_try->result;
    switch (match.verdict) {
      case MatchResult::Verdict::kSearching:
        if (verdict != Verdict::kLost) verdict = Verdict::kSearching;
        return;
      case MatchResult::Verdict::kAmbiguous: verdict = Verdict::kAmbiguous; return;
      case MatchResult::Verdict::kUnique: break;
    }
    ForgetFix();
    // Rooms find the map to decimetres, by the very walls that are about to be weighed.
    estimate.Begin(match.hypotheses.front().T_plan_map, !graph_search);
    for (size_t i = 1; i < match.hypotheses.size(); ++i) rivals.push_back(match.hypotheses[i].T_plan_map);
    verdict = Verdict::kLocalized;
    ever_fixed = true;
    SolveAll();
  }

  void SolveAll() {
    const bool solved = UnlessRaysContradict([&] { return estimate.Optimize(mapper, tells_all()); });
    if (!solved) return;
    news = true;
    solved_all_at = num_keyframes;
  }

  void SolveFinally() {
    UnlessRaysContradict([&] {
      estimate.OptimizeFinally(mapper);
      return true;
    });
  }

  // Half of the walls that a planar laser sees are furniture and its map is bent, so that walls alone would lay the plan now here, now
  // there: its rays lay the map anew as it grows, and what a solve makes of that is taken back where they clearly liked it better before.
  template <class Solve>
  bool UnlessRaysContradict(const Solve& solve) {
    if (!mapper.graph().planar) return solve();
    estimate.Lay(matcher.Refined(mapper.graph(), estimate.T_plan_map()));
    const double laid = RayScore();
    Mapper map = mapper;
    PlanEstimate before = estimate;
    if (!solve()) return false;
    if (RayScore() < laid - options.matcher.accept_margin_nats) {
      mapper = std::move(map);
      estimate = std::move(before);
    }
    return true;
  }

  [[nodiscard]] double RayScore() const { return matcher.Scores(mapper.graph(), std::array{estimate.T_plan_map()}).front(); }

  // Without a plan the map can at least be made consistent by itself.
  void Polish() {
    const PolishResult polished = PolishMap(mapper.graph(), PolishOptions());
    if (!polished.usable) return;
    std::vector<Keyframe>& keyframes = mapper.mutable_graph().keyframes;
    for (size_t i = 0; i < keyframes.size(); ++i) keyframes[i].T_map_kf = polished.T_map_kf[i];
    mapper.OnPosesChanged(true);
  }

  // Between two solves over everything, which cost more the larger the map is, only the newest keyframes are laid on it; those of a planar
  // laser stay where odometry has them.
  void Solve() {
    size_t kept = 0;
    for (const Keyframe& keyframe : mapper.graph().keyframes) kept += !keyframe.merged;
    if (static_cast<double>(num_keyframes - solved_all_at) >= options.solve_all_growth * static_cast<double>(kept)) return SolveAll();
    if (mapper.graph().planar) return;
    const std::vector<Eigen::Isometry3d> poses =
        OptimizeWindow(mapper.graph(), static_cast<size_t>(options.window_keyframes), estimate.SolverOptions(mapper.graph()));
    if (poses.empty()) return SolveAll();
    std::vector<Keyframe>& keyframes = mapper.mutable_graph().keyframes;
    for (size_t i = 0; i < poses.size(); ++i) keyframes[keyframes.size() - poses.size() + i].T_map_kf = poses[i];
    mapper.OnPosesChanged();
  }

  // Does the evidence still speak for the fix? A rival, or "outside the plan", that is better several times in a row ends it.
  void Rescore() {
    std::vector<Eigen::Isometry3d> poses = {estimate.T_plan_map()};
    poses.insert(poses.end(), rivals.begin(), rivals.end());
    const std::vector<double> scores = matcher.Scores(mapper.graph(), poses);
    double best_rival = 0;  // "outside the plan"
    for (size_t i = 1; i < scores.size(); ++i) best_rival = std::max(best_rival, scores[i]);
    votes_against = best_rival > scores.front() + options.rival_margin_nats ? votes_against + 1 : 0;
    if (votes_against < options.lost_after) return;
    verdict = Verdict::kLost;
    estimate.Hold(mapper.T_map_odom());
    // The plan has bent the map to a wrong place: back to what odometry says. (Surfaces that it had merged come apart.)
    for (Keyframe& keyframe : mapper.mutable_graph().keyframes) keyframe.T_map_kf = keyframe.T_odom_kf;
    mapper.OnPosesChanged();
    ForgetFix();
  }

  // After a keyframe that `scan` closed. True if what is due was held back.
  bool OnKeyframe(const RegisteredScan& scan, bool hold, std::vector<StageTime>& timing) {
    ++num_keyframes;
    if (placed()) {
      solve_due |= num_keyframes % static_cast<size_t>(options.optimize_every) == 0;
      rescore_due |= num_keyframes % static_cast<size_t>(options.rescore_every) == 0;
    }
    if (hold && num_held < kMaxHeld) {
      ++num_held;
      return true;
    }
    num_held = 0;
    Stopwatch watch;
    if (!placed()) {
      Search(scan.stamp_s, scan.odometry.T_odom_lidar);
      timing.push_back({"matching", watch.Lap()});
      return false;
    }
    if (std::exchange(solve_due, false)) Solve();
    timing.push_back({"optimization", watch.Lap()});
    if (std::exchange(rescore_due, false)) {
      Rescore();
      timing.push_back({"matching", watch.Lap()});
    }
    return false;
  }

  void Remember(double stamp_s, const Eigen::Isometry3d& T_odom_lidar) {
    const std::vector<Keyframe>& keyframes = mapper.graph().keyframes;
    places.push_back({stamp_s, keyframes.empty() ? 0 : keyframes.back().id, T_odom_lidar});
  }

  // Odometry has begun a new map: what is seen now is not tied to what was seen before, so neither must the graph be.
  void StartOver() {
    if (placed()) Archive();
    estimate.Hold(mapper.T_map_odom());
    mapper = Mapper(options.mapper);
    places.clear();
    num_keyframes = solved_all_at = doorways_judged_at = 0;
    last_try.reset();
    verdict = ever_fixed ? Verdict::kLost : Verdict::kSearching;
    ForgetFix();
  }

  // Keeps what a map that lies in the plan has to say, before it is given up.
  void Archive() {
    mapper.Flush();
    SolveFinally();
    const Trajectory poses = SmoothedPoses();
    earlier_poses.insert(earlier_poses.end(), poses.begin(), poses.end());
    DeviationReport report = Deviations(estimate);
    earlier_surfaces = std::move(report.surfaces);
    earlier_rooms = std::move(report.rooms);
    earlier_unplanned = std::move(report.unplanned);
    earlier_doorways = std::move(report.doorways);
  }

  [[nodiscard]] Trajectory SmoothedPoses() const {
    Trajectory out;
    out.reserve(places.size());
    const std::vector<Keyframe>& keyframes = mapper.graph().keyframes;
    for (const ScanPlace& place : places) {
      const Keyframe& keyframe = keyframes[place.keyframe];  // there is one: the fix came after it
      out.push_back({place.stamp_s, estimate.T_plan_map() * keyframe.T_map_kf * keyframe.T_odom_kf.inverse() * place.T_odom_lidar});
    }
    return out;
  }

  [[nodiscard]] bool tells_all() const { return options.on_update && options.update_every_solve; }

  // After a scan, if there is something to tell or somebody wants to know.
  void Tell(double stamp_s) {
    const bool requested = update_requested.exchange(false), changed = std::exchange(news, false) || verdict != told_verdict;
    if (!options.on_update || !(requested || (tells_all() && changed))) return;
    told_verdict = verdict;
    // Walls off, missing and unplanned wait for a request or the end, when all is judged with covariances; by a planar laser none are.
    std::optional<PlanEstimate> judged;
    if (requested && placed() && !mapper.graph().planar) {
      Mapper map = mapper;
      map.Flush();
      judged.emplace(estimate).OptimizeFinally(map);
    } else if (changed && placed() && static_cast<double>(num_keyframes) >= kDoorwayGrowth * static_cast<double>(doorways_judged_at)) {
      doorways_judged_at = num_keyframes;
      estimate.JudgeDoorways(mapper.graph());
    }
    const PlanEstimate& told = judged ? *judged : estimate;
    options.on_update({stamp_s, verdict, placed() ? std::optional(told.T_plan_map()) : std::nullopt, Deviations(told), requested});
  }

  [[nodiscard]] DeviationReport Deviations(const PlanEstimate& of) const {
    // What a planar laser takes for a wall may be the shelf in front of it: it is good enough to be found by, not to blame a wall for.
    DeviationReport report = AssessDeviations(plan, mapper.graph().planar ? JointResult() : of.joint(), options.deviations, of.changes());
    if (mapper.graph().planar) {
      report.gauge = report.unjudged = "A planar laser sees walls and furniture alike, on one line: walls are not judged.";
      for (SurfaceDeviation& d : report.surfaces) {
        if (d.unjudged == Unjudged::kNotSeen) d.unjudged = Unjudged::kPlanarLaser;
      }
    }
    for (size_t i = 0; i < earlier_surfaces.size(); ++i) {
      if (report.surfaces[i].status == SurfaceStatus::kUnobserved) report.surfaces[i] = earlier_surfaces[i];
    }
    for (size_t i = 0; i < earlier_rooms.size(); ++i) {
      if (report.rooms[i].status == SurfaceStatus::kUnobserved) report.rooms[i] = earlier_rooms[i];
    }
    for (size_t i = 0; i < earlier_doorways.size(); ++i) {
      if (report.doorways[i].status == DoorwayStatus::kUnobserved) report.doorways[i] = earlier_doorways[i];
    }
    const std::vector<UnplannedWall>& seen = of.changes().unplanned;
    for (const UnplannedWall& wall : earlier_unplanned) {
      if (std::none_of(seen.begin(), seen.end(), [&](const UnplannedWall& w) { return SameWall(w, wall); })) {
        report.unplanned.push_back(wall);
      }
    }
    return report;
  }
};

GraphEstimator::GraphEstimator(const AGraph& plan, const LocalizerOptions& options) : impl_(std::make_unique<Impl>(plan, options)) {}
GraphEstimator::~GraphEstimator() = default;

GraphState GraphEstimator::Add(const RegisteredScan& scan, bool hold) {
  Impl& s = *impl_;
  const OdometryResult& o = scan.odometry;
  GraphState out;
  Stopwatch watch;
  if (scan.odometry_map != s.odometry_map) s.StartOver();
  s.odometry_map = out.odometry_map = scan.odometry_map;
  // Scans that registration could not place stay out of the map, which still lies where it did.
  if (o.ok || o.restarted) {
    s.mapper.HoldPoses(s.placed());
    const bool grew = s.mapper.AddScan(o.deskewed, o.T_odom_lidar, o.planar ? std::optional(o.step_covariance) : std::nullopt, o.timed);
    out.timing.push_back({"mapping", watch.Lap()});
    if (grew) out.solve_held = s.OnKeyframe(scan, hold, out.timing);
    s.Remember(scan.stamp_s, o.T_odom_lidar);
  }
  out.verdict = s.verdict;
  out.hypotheses = s.last_try ? static_cast<int>(s.last_try->result.hypotheses.size()) : 0;
  out.last_try = s.last_try;
  if (s.ever_fixed) out.T_plan_odom = s.estimate.T_plan_map() * s.mapper.T_map_odom();
  s.Tell(scan.stamp_s);
  return out;
}

void GraphEstimator::RequestUpdate() { impl_->update_requested = true; }

void GraphEstimator::Finish() {
  impl_->mapper.Flush();
  if (impl_->placed()) {
    impl_->SolveFinally();
  } else {
    impl_->Polish();
  }
}

bool GraphEstimator::placed() const { return impl_->placed(); }
Eigen::Isometry3d GraphEstimator::T_plan_map() const { return impl_->estimate.T_plan_map(); }
const SGraph& GraphEstimator::map() const { return impl_->mapper.graph(); }
const MatchTry* GraphEstimator::last_try() const { return impl_->last_try.get(); }
const JointResult& GraphEstimator::estimate() const { return impl_->estimate.joint(); }
DeviationReport GraphEstimator::Deviations() const { return impl_->Deviations(impl_->estimate); }
Trajectory GraphEstimator::SmoothedPoses() const { return impl_->SmoothedPoses(); }
const Trajectory& GraphEstimator::earlier_poses() const { return impl_->earlier_poses; }

}  // namespace plumb::runtime
