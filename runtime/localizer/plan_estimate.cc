#include "runtime/localizer/plan_estimate.h"

#include <algorithm>
#include <cmath>

#include "runtime/deviations/planned_shapes.h"

namespace plumb::runtime {
namespace {

// Of a map's place by its rays. Where few walls are seen and one or two of them deviate, walls alone would lay the plan now on these, now
// on those. Half of the walls that a planar laser sees are furniture, which may agree with each other better than with the walls.
constexpr double kPlaceSigma_m = 0.1, kPlanarPlaceSigma_m = 0.05;

// Whether what is known of the wall now speaks against its plan. Where patches contradict each other nothing is certain of the wall, and it
// is not likely to deviate, though it is solved for as if it did.
bool SeemsToDeviate(const WallEstimate& wall, const DeviationOptions& options) {
  return wall.p_deviated >= 0.5 || std::abs(wall.deviation.offset_m) >= options.min_offset_m ||
         std::abs(wall.deviation.yaw_rad) >= options.min_yaw_rad;
}

}  // namespace

void FollowSplits(const std::vector<SurfaceSplit>& splits, std::vector<Match>* matches) {
  if (splits.empty()) return;
  for (const SurfaceSplit& split : splits) {
    const size_t before = matches->size();
    for (size_t i = 0; i < before; ++i) {
      if ((*matches)[i].map_surface != split.from) continue;
      (*matches)[i].mistaken.clear();
      Match part = (*matches)[i];
      part.map_surface = split.part;
      matches->push_back(std::move(part));
    }
  }
  std::stable_sort(matches->begin(), matches->end(), [](const Match& a, const Match& b) { return a.map_surface < b.map_surface; });
}

void PlanEstimate::Begin(const Eigen::Isometry3d& T_plan_map, bool prior) {
  Forget();
  T_plan_map_ = T_plan_map;
  T_found_ = prior ? std::optional(T_plan_map) : std::nullopt;
}

void PlanEstimate::Forget() {
  joint_ = {};
  matches_.clear();
  known_.assign(plan_->walls.size(), {});
  changes_ = {};
  other_shapes_.clear();
}

JointOptions PlanEstimate::SolverOptions(const SGraph& map) const {
  JointOptions out = options_->joint;
  if (!T_found_) return out;
  out.place = T_found_;
  out.place_sigma_m = map.planar ? kPlanarPlaceSigma_m : kPlaceSigma_m;
  return out;
}

// The walls of a surface that came apart have been judged as one. Once more is enough: a pose that moves now moves by little.
bool PlanEstimate::Solve(Mapper& mapper, bool covariances, bool judging) {
  std::vector<SurfaceSplit> splits;
  if (!SolveOnce(mapper, covariances, judging, &splits)) return false;
  if (judging && !splits.empty()) SolveOnce(mapper, covariances, judging, &splits);
  return true;
}

bool PlanEstimate::SolveOnce(Mapper& mapper, bool covariances, bool judging, std::vector<SurfaceSplit>* splits) {
  std::vector<Match> matches = MatchSurfaces(mapper.graph(), *plan_, T_plan_map_, known_, options_->coupling);
  // Whatever stands where a wall is missing is not that wall.
  std::erase_if(matches, [&](const Match& m) {
    return m.plan_surface.valid() && (changes_.IsMissing(WallOf(m)) || other_shapes_.contains({m.map_surface, WallOf(m)}));
  });
  if (matches.empty()) return false;
  JointOptions options = SolverOptions(mapper.graph());
  options.covariances = covariances;
  options.fit_tolerance = judging;
  JointResult solved = OptimizeJointly(mapper.graph(), *plan_, matches, T_plan_map_, options);
  if (solved.T_map_kf.empty()) return false;  // unusable; a solution short of its last digit is not
  joint_ = std::move(solved);
  matches_ = std::move(matches);
  T_plan_map_ = joint_.T_plan_map;
  for (const WallEstimate& wall : joint_.walls) known_[wall.wall.index()] = wall.deviation;
  std::vector<Keyframe>& keyframes = mapper.mutable_graph().keyframes;
  for (size_t i = 0; i < keyframes.size() && i < joint_.T_map_kf.size(); ++i) keyframes[i].T_map_kf = joint_.T_map_kf[i];
  *splits = mapper.OnPosesChanged(judging);
  FollowSplits(*splits, &matches_);
  for (const SurfaceSplit& split : *splits) {
    std::erase_if(other_shapes_, [&](const auto& shape) { return shape.first == split.part; });  // of what was in its slot before
    std::vector<std::pair<uint32_t, WallId>> of_part;
    for (const auto& [surface, wall] : other_shapes_) {
      if (surface == split.from) of_part.emplace_back(split.part, wall);
    }
    other_shapes_.insert(of_part.begin(), of_part.end());
  }
  return true;
}

// What makes walls deviate and is something else that the plan has there. Told anew each time: what was seen since may tell otherwise.
void PlanEstimate::FindOtherShapes(const SGraph& map) {
  const std::vector<bool> on_other_shape = MatchesOnOtherShapes(map, *plan_, matches_, joint_);
  for (const WallEstimate& wall : joint_.walls) {
    if (!SeemsToDeviate(wall, options_->deviations)) continue;
    for (size_t i = 0; i < matches_.size(); ++i) {
      if (!on_other_shape[i] || WallOf(matches_[i]) != wall.wall) continue;
      other_shapes_.insert({matches_[i].map_surface, wall.wall});
      known_[wall.wall.index()] = {};  // where it was looked for was the other shape's place
    }
  }
}

void PlanEstimate::OptimizeFinally(Mapper& mapper) {
  other_shapes_.clear();
  Solve(mapper, true, true);
  if (matches_.empty()) return;
  changes_.presence = JudgePresence(mapper.graph(), *plan_, joint_, options_->deviations.presence);
  const auto is_missing = [&](const WallEstimate& wall) { return changes_.IsMissing(wall.wall); };
  if (std::any_of(joint_.walls.begin(), joint_.walls.end(), is_missing)) Solve(mapper, true, true);
  FindOtherShapes(mapper.graph());
  if (!other_shapes_.empty()) Solve(mapper, true, true);
  changes_.unplanned = FindUnplannedWalls(mapper.graph(), *plan_, matches_, joint_, options_->deviations.unplanned);
  changes_.on_other_shape = LieOnOtherShapes(mapper.graph(), *plan_, matches_, joint_);
  JudgeDoorways(mapper.graph());
}

void PlanEstimate::JudgeDoorways(const SGraph& map) {
  changes_.doorways = runtime::JudgeDoorways(map, *plan_, joint_, changes_.presence, options_->deviations.doorways);
}

}  // namespace plumb::runtime
