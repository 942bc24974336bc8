#include "runtime/matching/guidance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/matching/ray_likelihood.h"
#include "runtime/matching/walks.h"
#include "schema/polygon.h"

namespace plumb::runtime {
namespace {

constexpr double kUsualSensorHeight_m = 0.6, kFirstLeg_m = 0.5;

class GoalSearch {
 public:
  GoalSearch(const PlanIndex& plan, const SGraph& map, const MatchResult& match, int rivals, const Eigen::Isometry3d& T_map_lidar,
             const MatcherOptions& options, const GuidanceOptions& guidance)
      : plan_(plan), map_(map), options_(options), guidance_(guidance), T_plan_map_(match.hypotheses.front().T_plan_map),
        T_plan_lidar_(T_plan_map_ * T_map_lidar) {
    for (int i = 1; i <= rivals; ++i) T_rival_best_.push_back(match.hypotheses[static_cast<size_t>(i)].T_plan_map * T_plan_map_.inverse());
    const RoomId room = RoomAt(plan.plan(), T_plan_lidar_.translation());
    if (room.valid()) height_m_ = T_plan_lidar_.translation().z() - plan.plan().rooms[room.index()].floor_z_m;
  }

  [[nodiscard]] std::optional<Goal> Find() {
    stops_ = WalksFrom(plan_.plan(), T_plan_lidar_.translation(), guidance_.max_walk_m, static_cast<size_t>(guidance_.max_stops));
    Look();
    std::optional<Goal> best;
    std::vector<std::vector<double>> told;  // nats per stop and rival, with the way there
    for (size_t i = 0; i < stops_.size(); ++i) {
      told.push_back(stops_[i].before < 0 ? std::vector<double>(T_rival_best_.size(), 0.0) : told[static_cast<size_t>(stops_[i].before)]);
      if (!IsKnown(stops_[i])) {
        for (size_t k = 0; k < T_rival_best_.size(); ++k) told[i][k] += Told(i, T_rival_best_[k]);
      }
      const Goal goal = ToGoal(i, told[i]);
      if (goal.rivals_split > (best ? best->rivals_split : 0)) best = goal;
      if (best && best->rivals_split == static_cast<int>(T_rival_best_.size())) break;
    }
    return best;
  }

 private:
  [[nodiscard]] Eigen::Vector3d EyeAt(const WalkStop& stop) const { return stop.position_m + height_m_ * Eigen::Vector3d::UnitZ(); }

  [[nodiscard]] bool IsKnown(const WalkStop& stop) const {
    return std::any_of(map_.keyframes.begin(), map_.keyframes.end(), [&](const Keyframe& keyframe) {
      return ((T_plan_map_ * keyframe.T_map_kf).translation() - stop.position_m).head<2>().norm() < guidance_.known_radius_m;
    });
  }

  // What the plan shows from `eye` (plan frame) to all sides, doors open; mesh frame.
  [[nodiscard]] std::vector<MapRay> LookFrom(const Eigen::Vector3d& eye) const {
    std::vector<MapRay> rays;
    for (int i = 0; i < guidance_.num_azimuths; ++i) {
      const double azimuth_rad = 2 * std::numbers::pi * i / guidance_.num_azimuths;
      MapRay ray;
      ray.origin = eye - plan_.plan().origin;
      ray.direction = {std::cos(azimuth_rad), std::sin(azimuth_rad), 0};
      const PlanHit hit = plan_.Cast({ray.origin.cast<float>(), ray.direction.cast<float>()});
      if (!hit.solid.hit()) continue;
      ray.range_m = hit.solid.range_m;
      rays.push_back(ray);
    }
    return rays;
  }

  void Look() {
    std::vector<MapRay> all;
    for (const WalkStop& stop : stops_) {
      looks_.push_back(LookFrom(EyeAt(stop)));
      all.insert(all.end(), looks_.back().begin(), looks_.back().end());
    }
    background_ = RangeBackground(all);
  }

  // By how much a look in the plan speaks against the plan laid so that what is here is at T * here. 0 if not at all.
  [[nodiscard]] double Gap(std::vector<MapRay> rays, const Eigen::Isometry3d& T) const {
    MapView view;
    view.rays = std::move(rays);
    view.background = background_;
    PlanarPose moved;
    moved.yaw_rad = std::atan2(T.linear()(1, 0), T.linear()(0, 0));
    const Eigen::Vector3d t = T * plan_.plan().origin - plan_.plan().origin;
    moved.t_m = t.head<2>();
    moved.z_m = t.z();
    const double nats =
        JudgeRays(plan_, view, PlanarPose(), options_).log_likelihood - JudgeRays(plan_, view, moved, options_).log_likelihood;
    return std::max(0.0, nats * guidance_.seen_ratio * guidance_.keyframes_per_stop * options_.rays_per_keyframe / guidance_.num_azimuths);
  }

  // If the best hypothesis is true, or if the rival is, whichever shows less.
  [[nodiscard]] double Told(size_t stop, const Eigen::Isometry3d& T_rival_best) const {
    const double if_best = Gap(looks_[stop], T_rival_best);
    const Eigen::Vector3d eye = T_rival_best * EyeAt(stops_[stop]);
    if (if_best == 0 || !RoomAt(plan_.plan(), eye).valid()) return if_best;  // one cannot get there where no room is
    return std::min(if_best, Gap(LookFrom(eye), T_rival_best.inverse()));
  }

  [[nodiscard]] Goal ToGoal(size_t stop, const std::vector<double>& told) const {
    Goal goal;
    goal.position_m = stops_[stop].position_m;
    goal.distance_m = stops_[stop].distance_m;
    goal.bearing_rad = BearingOf(stop);
    goal.rooms.push_back(stops_[stop].room);
    for (size_t k = 0; k < told.size(); ++k) {
      goal.rooms.push_back(RoomAt(plan_.plan(), T_rival_best_[k] * EyeAt(stops_[stop])));
      if (told[k] < options_.accept_margin_nats) continue;
      goal.expected_nats = goal.rivals_split++ == 0 ? told[k] : std::min(goal.expected_nats, told[k]);
    }
    return goal;
  }

  // Of the first stop on the way that is not right at the robot.
  [[nodiscard]] double BearingOf(size_t stop) const {
    const auto way_to = [&](size_t i) -> Eigen::Vector2d { return (stops_[i].position_m - T_plan_lidar_.translation()).head<2>(); };
    Eigen::Vector2d way = way_to(stop);
    for (int i = stops_[stop].before; i >= 0; i = stops_[static_cast<size_t>(i)].before) {
      if (way_to(static_cast<size_t>(i)).norm() > kFirstLeg_m) way = way_to(static_cast<size_t>(i));
    }
    const Eigen::Vector3d ahead = T_plan_lidar_.linear().col(0);
    return WrapAngle(std::atan2(way.y(), way.x()) - std::atan2(ahead.y(), ahead.x()));
  }

  const PlanIndex& plan_;
  const SGraph& map_;
  const MatcherOptions& options_;
  const GuidanceOptions& guidance_;
  const Eigen::Isometry3d T_plan_map_, T_plan_lidar_;  // under the best hypothesis
  std::vector<Eigen::Isometry3d> T_rival_best_;        // plan frame: from a place under the best hypothesis to the same under a rival
  double height_m_ = kUsualSensorHeight_m;
  std::vector<WalkStop> stops_;
  std::vector<std::vector<MapRay>> looks_;             // per stop
  RangeBackground background_{{}};
};

}  // namespace

std::string GuidanceOptions::Check() const {
  const auto bad = [](const char* name, double value, const char* rule) {
    return fmt::format("GuidanceOptions.{} = {}; must be {}", name, value, rule);
  };
  if (!(max_walk_m > 0)) return bad("max_walk_m", max_walk_m, "positive");
  if (max_stops < 1) return bad("max_stops", max_stops, "at least 1");
  if (max_rivals < 1) return bad("max_rivals", max_rivals, "at least 1");
  if (num_azimuths < 8) return bad("num_azimuths", num_azimuths, "at least 8");
  if (!(seen_ratio > 0 && seen_ratio <= 1)) return bad("seen_ratio", seen_ratio, "in (0, 1]");
  if (keyframes_per_stop < 1) return bad("keyframes_per_stop", keyframes_per_stop, "at least 1");
  if (!(known_radius_m >= 0)) return bad("known_radius_m", known_radius_m, "at least 0");
  return {};
}

std::optional<Guidance> Guide(const PlanIndex& plan, const SGraph& map, const MatchResult& match, const Eigen::Isometry3d& T_map_lidar,
                              const MatcherOptions& options, const GuidanceOptions& guidance) {
  if (match.verdict == MatchResult::Verdict::kUnique || match.hypotheses.empty()) return std::nullopt;
  const double best = match.hypotheses.front().log_likelihood;
  const auto rivals = std::count_if(match.hypotheses.begin() + 1, match.hypotheses.end(),
                                    [&](const Hypothesis& h) { return best - h.log_likelihood < options.accept_margin_nats; });
  if (rivals == 0 || best <= 0) return std::nullopt;
  Guidance out;
  out.rivals = std::min(static_cast<int>(rivals), guidance.max_rivals);
  out.goal = GoalSearch(plan, map, match, out.rivals, T_map_lidar, options, guidance).Find();
  return out;
}

}  // namespace plumb::runtime
