#include "runtime/matching/graph/graph_search.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

namespace plumb::runtime {
namespace {

constexpr double kSensorHeight_m = 0.6;  // where neither floor nor ceiling was seen

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace

GraphSearch::GraphSearch(const AGraph& plan, const GraphMatcherOptions& options) : origin_(plan.origin), options_(options) {
  for (size_t i = 0; i < plan.storeys.size(); ++i) {
    std::vector<double> floors, ceilings;
    for (const Room& room : plan.rooms) {
      if (room.storey != StoreyId(i)) continue;
      floors.push_back(room.floor_z_m - origin_.z());
      ceilings.push_back(room.ceiling_z_m - origin_.z());
    }
    if (floors.empty()) continue;
    levels_.push_back({StoreyId(i), Median(floors), Median(ceilings), GraphMatcher(PlanGraph(plan, StoreyId(i), options.rooms), options)});
  }
}

Hypothesis GraphSearch::At(const Level& level, const MapFloor& floor, const PlanarPose& pose) const {
  const double z_m = floor.floor_z_m     ? level.floor_z_m - *floor.floor_z_m
                     : floor.ceiling_z_m ? level.ceiling_z_m - *floor.ceiling_z_m
                                         : level.floor_z_m + kSensorHeight_m - floor.sensor_z_m;
  Hypothesis out;
  out.T_plan_map = Eigen::Translation3d(origin_ + Eigen::Vector3d(pose.t_m.x(), pose.t_m.y(), z_m)) *
                   Eigen::AngleAxisd(pose.yaw_rad, Eigen::Vector3d::UnitZ());
  out.storey = level.storey;
  return out;
}

MatchResult GraphSearch::Match(const SGraph& map) const {
  MatchResult result;
  const UpperLayers layers = DeriveUpperLayers(map);
  MatchGraph rooms;
  const MapFloor* floor = nullptr;
  for (const MapFloor& f : layers.floors) {
    MatchGraph graph = MapGraph(map, layers, f.id, options_.rooms);
    if (floor != nullptr && graph.rooms.size() <= rooms.rooms.size()) continue;
    floor = &f;
    rooms = std::move(graph);
  }
  if (floor == nullptr || levels_.empty()) {
    result.reason = levels_.empty() ? "the plan has no rooms" : "the map has no rooms";
    return result;
  }
  const Level* best_level = nullptr;
  GraphMatch best;
  double walls = 0, next_support = 0;
  for (const GraphRoom& room : rooms.rooms) walls += static_cast<double>(room.walls.size());
  for (const Level& level : levels_) {
    GraphMatch match = level.matcher.Match(rooms);
    if (best_level == nullptr || match.support > best.support) {
      next_support = best.support;
      best = std::move(match);
      best_level = &level;
    } else {
      next_support = std::max(next_support, match.support);
    }
  }
  result.verdict = best.verdict;
  result.reason = best.reason;
  if (best.verdict == MatchResult::Verdict::kSearching) return result;
  result.hypotheses.push_back(At(*best_level, *floor, best.pose));
  for (const PlanarPose& rival : best.rivals) result.hypotheses.push_back(At(*best_level, *floor, rival));
  if (next_support >= best.support - options_.symmetry_epsilon * walls) {
    result.verdict = MatchResult::Verdict::kAmbiguous;
    result.reason = "rooms of two storeys agree equally well with the rooms of the map";
  }
  for (Hypothesis& h : result.hypotheses) {
    h.probability = 1 / static_cast<double>(result.hypotheses.size());
    h.consistent_planes = static_cast<int>(best.support);
    h.consistent_ratio = best.score;
  }
  result.probability_outside = 0;
  return result;
}

}  // namespace plumb::runtime
