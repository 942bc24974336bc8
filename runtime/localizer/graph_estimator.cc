#include "runtime/localizer/graph_estimator.h"

#include <algorithm>
#include <atomic>
#include <set>
#include <utility>

#include "runtime/coupling/coupling.h"
#include "runtime/deviations/planned_shapes.h"
#include "runtime/localizer/stopwatch.h"
#include "runtime/mapping/mapper.h"
#include "runtime/matching/graph/graph_search.h"
#include "runtime/optimization/map_polish.h"
#include "runtime/optimization/window_optimizer.h"

namespace plumb::runtime {
namespace {

// Of a map's place by its rays. Where few walls are seen and one or two of them deviate, walls alone would lay the plan now on these, now
// on those. Half of the walls that a planar laser sees are furniture, which may agree with each other better than with the walls.
constexpr double kPlaceSigma_m = 0.1, kPlanarPlaceSigma_m = 0.05;

constexpr double kDoorwayGrowth = 1.25;  // of the map, between two updates that judge doorways
constexpr int kMaxHeld = 10;  // keyframes in a row: a robot that nobody looks for is never found

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
      : plan(plan_in), options(options_in), mapper(options.mapper), matcher(plan, options.matcher) {
    if (options.matcher_kind == MatcherKind::kGraph) graph_search.emplace(plan, options.graph_matcher);
    ForgetFix();
  }

  const AGraph& plan;
  LocalizerOptions options;
  Mapper mapper;
  Matcher matcher;
  std::optional<GraphSearch> graph_search;  // where rooms are to find the map instead of walls

  Verdict verdict = Verdict::kSearching;
  std::shared_ptr<const MatchTry> last_try;  // of the present map
  JointResult joint;
  std::vector<Match> matches;  // that `joint` is based on
  WallChanges changes;         // as last judged
  std::set<std::pair<uint32_t, WallId>> other_shapes;  // map surfaces that are something else of the plan than this wall
  Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();  // of the last fix
  Eigen::Isometry3d T_found = Eigen::Isometry3d::Identity();   // as the matcher found it
  bool ever_fixed = false;
  int odometry_map = 0;
  size_t num_keyframes = 0;               // made of the present map so far, ...
  size_t solved_all_at = 0;               // ... and when everything was last solved
  size_t doorways_judged_at = 0;          // ... and when doorways last were, for an update
  bool solve_due = false, rescore_due = false;
  int num_held = 0;                       // keyframes in a row that were only mapped
  std::vector<WallDeviation> known;       // per plan wall, as estimated so far
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
    known.assign(plan.walls.size(), {});
    rivals.clear();
    votes_against = 0;
    solve_due = rescore_due = false;
    joint = {};
    matches.clear();
    changes = {};
    other_shapes.clear();
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
    T_plan_map = T_found = match.hypotheses.front().T_plan_map;
    for (size_t i = 1; i < match.hypotheses.size(); ++i) rivals.push_back(match.hypotheses[i].T_plan_map);
    verdict = Verdict::kLocalized;
    ever_fixed = true;
    Optimize(false);
  }

  [[nodiscard]] JointOptions SolverOptions() const {
    JointOptions out = options.joint;
    if (graph_search) return out;  // it finds the map to decimetres, by the very walls that are about to be weighed
    out.place = T_found;
    out.place_sigma_m = mapper.graph().planar ? kPlanarPlaceSigma_m : kPlaceSigma_m;
    return out;
  }

  struct Solution {
    std::vector<Match> matches;
    JointResult joint;
  };

  // `judging`: with all that a judgement of walls rests on.
  [[nodiscard]] std::optional<Solution> Solved(bool judging) const {
    Solution out;
    out.matches = MatchSurfaces(mapper.graph(), plan, T_plan_map, known, options.coupling);
    // Whatever stands where a wall is missing is not that wall.
    std::erase_if(out.matches, [&](const Match& m) {
      return m.plan_surface.valid() && (changes.IsMissing(WallOf(m)) || other_shapes.contains({m.map_surface, WallOf(m)}));
    });
    if (out.matches.empty()) return std::nullopt;
    JointOptions joint_options = SolverOptions();
    joint_options.covariances = judging || tells_all();
    joint_options.fit_tolerance = judging;
    out.joint = OptimizeJointly(mapper.graph(), plan, out.matches, T_plan_map, joint_options);
    if (out.joint.T_map_kf.empty()) return std::nullopt;  // unusable; a solution short of its last digit is not
    return out;
  }

  // Couples map and plan at the current estimate and solves everything jointly. Covariances cost half of the time and steer nothing:
  // they are left out until somebody asks.
  void Optimize(bool judging) {
    std::optional<Solution> solution = Solved(judging);
    if (!solution) return;
    joint = std::move(solution->joint);
    matches = std::move(solution->matches);
    news = true;
    T_plan_map = joint.T_plan_map;
    for (const WallEstimate& wall : joint.walls) known[wall.wall.index()] = wall.deviation;
    std::vector<Keyframe>& keyframes = mapper.mutable_graph().keyframes;
    for (size_t i = 0; i < keyframes.size() && i < joint.T_map_kf.size(); ++i) keyframes[i].T_map_kf = joint.T_map_kf[i];
    mapper.OnPosesChanged();
    solved_all_at = num_keyframes;
  }

  [[nodiscard]] WallId WallOf(const Match& match) const { return plan.surfaces[match.plan_surface.index()].wall; }

  // What makes walls deviate and is something else that the plan has there. Told anew each time: what was seen since may tell otherwise.
  void FindOtherShapes() {
    const std::vector<bool> on_other_shape = MatchesOnOtherShapes(mapper.graph(), plan, matches, joint);
    for (const WallEstimate& wall : joint.walls) {
      if (wall.p_deviated < 0.5) continue;
      for (size_t i = 0; i < matches.size(); ++i) {
        if (!on_other_shape[i] || WallOf(matches[i]) != wall.wall) continue;
        other_shapes.insert({matches[i].map_surface, wall.wall});
        known[wall.wall.index()] = {};  // where it was looked for was the other shape's place
      }
    }
  }

  // The last word on a map that lies in the plan: with covariances, and without the walls that are not there.
  void OptimizeFinally() {
    other_shapes.clear();
    Optimize(true);
    if (matches.empty()) return;
    changes.presence = JudgePresence(mapper.graph(), plan, joint, options.deviations.presence);
    const auto is_missing = [&](const WallEstimate& wall) { return changes.IsMissing(wall.wall); };
    if (std::any_of(joint.walls.begin(), joint.walls.end(), is_missing)) Optimize(true);
    FindOtherShapes();
    if (!other_shapes.empty()) Optimize(true);
    changes.unplanned = FindUnplannedWalls(mapper.graph(), plan, matches, joint, options.deviations.unplanned);
    changes.on_other_shape = LieOnOtherShapes(mapper.graph(), plan, matches, joint);
    changes.doorways = JudgeDoorways(mapper.graph(), plan, joint, changes.presence, options.deviations.doorways);
  }

  // Without a plan the map can at least be made consistent by itself.
  void Polish() {
    const PolishResult polished = PolishMap(mapper.graph(), PolishOptions());
    if (!polished.usable) return;
    std::vector<Keyframe>& keyframes = mapper.mutable_graph().keyframes;
    for (size_t i = 0; i < keyframes.size(); ++i) keyframes[i].T_map_kf = polished.T_map_kf[i];
    mapper.OnPosesChanged();
  }

  // Between two solves over everything, which cost more the larger the map is, only the newest keyframes are laid on it; those of a planar
  // laser stay where odometry has them.
  void Solve() {
    size_t kept = 0;
    for (const Keyframe& keyframe : mapper.graph().keyframes) kept += !keyframe.merged;
    if (static_cast<double>(num_keyframes - solved_all_at) >= options.solve_all_growth * static_cast<double>(kept)) return Optimize(false);
    if (mapper.graph().planar) return;
    const std::vector<Eigen::Isometry3d> poses =
        OptimizeWindow(mapper.graph(), static_cast<size_t>(options.window_keyframes), SolverOptions());
    if (poses.empty()) return Optimize(false);
    std::vector<Keyframe>& keyframes = mapper.mutable_graph().keyframes;
    for (size_t i = 0; i < poses.size(); ++i) keyframes[keyframes.size() - poses.size() + i].T_map_kf = poses[i];
    mapper.OnPosesChanged();
  }

  // Does the evidence still speak for the fix? A rival, or "outside the plan", that is better several times in a row ends it.
  void Rescore() {
    std::vector<Eigen::Isometry3d> poses = {T_plan_map};
    poses.insert(poses.end(), rivals.begin(), rivals.end());
    const std::vector<double> scores = matcher.Scores(mapper.graph(), poses);
    double best_rival = 0;  // "outside the plan"
    for (size_t i = 1; i < scores.size(); ++i) best_rival = std::max(best_rival, scores[i]);
    votes_against = best_rival > scores.front() + options.rival_margin_nats ? votes_against + 1 : 0;
    if (votes_against < options.lost_after) return;
    verdict = Verdict::kLost;
    HoldPose();
    // The plan has bent the map to a wrong place: back to what odometry says. (Surfaces that were merged meanwhile stay merged.)
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

  // From now on the pose is odometry's, going on from where it is.
  void HoldPose() { T_plan_map = T_plan_map * mapper.T_map_odom(); }

  // Odometry has begun a new map: what is seen now is not tied to what was seen before, so neither must the graph be.
  void StartOver() {
    if (placed()) Archive();
    HoldPose();
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
    OptimizeFinally();
    const Trajectory poses = SmoothedPoses();
    earlier_poses.insert(earlier_poses.end(), poses.begin(), poses.end());
    DeviationReport report = Deviations(joint, changes);
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
      out.push_back({place.stamp_s, T_plan_map * keyframe.T_map_kf * keyframe.T_odom_kf.inverse() * place.T_odom_lidar});
    }
    return out;
  }

  [[nodiscard]] bool tells_all() const { return options.on_update && options.update_every_solve; }

  // After a scan, if there is something to tell or somebody wants to know.
  void Tell(double stamp_s) {
    const bool requested = update_requested.exchange(false), changed = std::exchange(news, false) || verdict != told_verdict;
    if (!options.on_update || !(requested || (tells_all() && changed))) return;
    told_verdict = verdict;
    // The estimate at hand may be one without covariances, and without them nothing is judged.
    const std::optional<Solution> fresh = requested && placed() ? Solved(true) : std::nullopt;
    // Walls off, missing and unplanned wait for such a request or the end. Doorways are judged as the map grows: from all its points, which
    // takes as long as a solve.
    if (changed && !fresh && placed() && static_cast<double>(num_keyframes) >= kDoorwayGrowth * static_cast<double>(doorways_judged_at)) {
      doorways_judged_at = num_keyframes;
      changes.doorways = JudgeDoorways(mapper.graph(), plan, joint, changes.presence, options.deviations.doorways);
    }
    const DeviationReport report = fresh ? Deviations(fresh->joint, ChangesSeen(*fresh)) : Deviations(joint, changes);
    options.on_update({stamp_s, verdict, placed() ? std::optional(T_plan_map) : std::nullopt, report, requested});
  }

  [[nodiscard]] WallChanges ChangesSeen(const Solution& solution) const {
    WallChanges seen;
    seen.presence = JudgePresence(mapper.graph(), plan, solution.joint, options.deviations.presence);
    seen.unplanned = FindUnplannedWalls(mapper.graph(), plan, solution.matches, solution.joint, options.deviations.unplanned);
    seen.on_other_shape = LieOnOtherShapes(mapper.graph(), plan, solution.matches, solution.joint);
    seen.doorways = JudgeDoorways(mapper.graph(), plan, solution.joint, seen.presence, options.deviations.doorways);
    return seen;
  }

  [[nodiscard]] DeviationReport Deviations(const JointResult& estimate, const WallChanges& seen) const {
    // What a planar laser takes for a wall may be the shelf in front of it: it is good enough to be found by, not to blame a wall for.
    DeviationReport report = AssessDeviations(plan, mapper.graph().planar ? JointResult() : estimate, options.deviations, seen);
    if (mapper.graph().planar) report.gauge = "A planar laser sees walls and furniture alike, on one line: walls are not judged.";
    for (size_t i = 0; i < earlier_surfaces.size(); ++i) {
      if (report.surfaces[i].status == SurfaceStatus::kUnobserved) report.surfaces[i] = earlier_surfaces[i];
    }
    for (size_t i = 0; i < earlier_rooms.size(); ++i) {
      if (report.rooms[i].status == SurfaceStatus::kUnobserved) report.rooms[i] = earlier_rooms[i];
    }
    for (size_t i = 0; i < earlier_doorways.size(); ++i) {
      if (report.doorways[i].status == DoorwayStatus::kUnobserved) report.doorways[i] = earlier_doorways[i];
    }
    for (const UnplannedWall& wall : earlier_unplanned) {
      if (std::none_of(changes.unplanned.begin(), changes.unplanned.end(), [&](const UnplannedWall& w) { return SameWall(w, wall); })) {
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
  if (s.ever_fixed) out.T_plan_odom = s.T_plan_map * s.mapper.T_map_odom();
  s.Tell(scan.stamp_s);
  return out;
}

void GraphEstimator::RequestUpdate() { impl_->update_requested = true; }

void GraphEstimator::Finish() {
  impl_->mapper.Flush();
  if (impl_->placed()) {
    impl_->OptimizeFinally();
  } else {
    impl_->Polish();
  }
}

bool GraphEstimator::placed() const { return impl_->placed(); }
Eigen::Isometry3d GraphEstimator::T_plan_map() const { return impl_->T_plan_map; }
const SGraph& GraphEstimator::map() const { return impl_->mapper.graph(); }
const MatchTry* GraphEstimator::last_try() const { return impl_->last_try.get(); }
const JointResult& GraphEstimator::estimate() const { return impl_->joint; }
DeviationReport GraphEstimator::Deviations() const { return impl_->Deviations(impl_->joint, impl_->changes); }
Trajectory GraphEstimator::SmoothedPoses() const { return impl_->SmoothedPoses(); }
const Trajectory& GraphEstimator::earlier_poses() const { return impl_->earlier_poses; }

}  // namespace plumb::runtime
