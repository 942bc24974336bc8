#include "tools/plumb/match_rows.h"

#include <cmath>

#include "schema/polygon.h"

namespace plumb::tools {
namespace {

constexpr double kLeastProbability = 1e-3;  // of the best one's

const char* VerdictName(runtime::MatchResult::Verdict verdict) {
  switch (verdict) {
    case runtime::MatchResult::Verdict::kSearching: return "searching";
    case runtime::MatchResult::Verdict::kAmbiguous: return "ambiguous";
    case runtime::MatchResult::Verdict::kUnique: return "unique";
  }
  return "searching";
}

HypothesisRow ToRow(const AGraph& plan, const runtime::Hypothesis& h, const Eigen::Isometry3d& T_map_lidar) {
  const Eigen::Isometry3d T_plan_lidar = h.T_plan_map * T_map_lidar;
  HypothesisRow row;
  row.probability = h.probability;
  row.log_likelihood = h.log_likelihood;
  row.position_m = T_plan_lidar.translation();
  row.yaw_rad = std::atan2(T_plan_lidar.linear()(1, 0), T_plan_lidar.linear()(0, 0));
  row.sigma_xy_m = h.sigma_xy_m;
  row.sigma_yaw_rad = h.sigma_yaw_rad;
  if (h.storey.valid()) row.storey = plan.storeys[h.storey.index()].name;
  if (const RoomId room = RoomAt(plan, row.position_m); room.valid()) {
    row.room = room;
    row.room_name = plan.rooms[room.index()].name;
  }
  row.consistent_planes = h.consistent_planes;
  row.consistent_ratio = h.consistent_ratio;
  row.explained_ratio = h.explained_ratio;
  row.through_ratio = h.through_ratio;
  return row;
}

}  // namespace

TryRow ToRow(const AGraph& plan, const runtime::MatchTry& attempt) {
  TryRow row{attempt.stamp_s, VerdictName(attempt.result.verdict), attempt.result.reason, attempt.result.probability_outside, {}};
  for (const runtime::Hypothesis& h : attempt.result.hypotheses) {
    if (!row.hypotheses.empty() && h.probability < kLeastProbability * row.hypotheses.front().probability) break;
    row.hypotheses.push_back(ToRow(plan, h, attempt.T_map_lidar));
  }
  return row;
}

}  // namespace plumb::tools
