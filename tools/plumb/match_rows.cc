#include "tools/plumb/match_rows.h"

#include <cmath>

#include "schema/polygon.h"

namespace plumb::tools {
namespace {

constexpr double kLeastProbability = 1e-3;  // of the best one's
constexpr double kOpen = 100;               // m or rad: a direction that nothing measures has a sigma beyond

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
  if (h.sigma_xy_m < kOpen) row.sigma_xy_m = h.sigma_xy_m;
  if (h.sigma_yaw_rad < kOpen) row.sigma_yaw_rad = h.sigma_yaw_rad;
  if (h.storey.valid()) row.storey = plan.storeys[h.storey.index()].name;
  if (const RoomId room = RoomAt(plan, row.position_m); room.valid()) {
    row.room = room;
    row.room_name = plan.rooms[room.index()].name;
  }
  row.consistent_planes = h.consistent_planes;
  row.consistent_ratio = h.consistent_ratio;
  row.explained_ratio = h.explained_ratio;
  row.through_ratio = h.through_ratio;
  row.in_front_ratio = h.in_front_ratio;
  return row;
}

DriveToRow ToRow(const AGraph& plan, const runtime::Goal& goal) {
  DriveToRow row;
  for (const RoomId room : goal.rooms) {
    row.rooms.push_back(room.valid() ? std::optional(room) : std::nullopt);
    row.room_names.push_back(room.valid() ? plan.rooms[room.index()].name : "");
  }
  row.position_m = goal.position_m;
  row.bearing_rad = goal.bearing_rad;
  row.distance_m = goal.distance_m;
  row.expected_nats = goal.expected_nats;
  row.rivals_split = goal.rivals_split;
  return row;
}

}  // namespace

TryRow ToRow(const AGraph& plan, const runtime::MatchTry& attempt) {
  TryRow row{attempt.stamp_s, VerdictName(attempt.result.verdict), attempt.result.reason, attempt.result.probability_outside, {}, {}};
  if (attempt.guidance) {
    row.guidance = GuidanceRow{attempt.guidance->rivals, std::nullopt};
    if (attempt.guidance->goal) row.guidance->drive_to = ToRow(plan, *attempt.guidance->goal);
  }
  for (const runtime::Hypothesis& h : attempt.result.hypotheses) {
    if (!row.hypotheses.empty() && h.probability < kLeastProbability * row.hypotheses.front().probability) break;
    row.hypotheses.push_back(ToRow(plan, h, attempt.T_map_lidar));
  }
  return row;
}

}  // namespace plumb::tools
