// Options of the localizer and all its stages.
#pragma once

#include <string>

#include "runtime/coupling/coupling.h"
#include "runtime/deviations/deviations.h"
#include "runtime/localizer/estimate_update.h"
#include "runtime/mapping/mapper_options.h"
#include "runtime/matching/graph/graph_matcher.h"
#include "runtime/matching/matcher.h"
#include "runtime/matching/start_hint.h"
#include "runtime/odometry/odometry.h"
#include "runtime/optimization/joint_optimizer.h"

namespace plumb::runtime {

// What finds the map in the plan: walls and rays (matcher.h), or rooms by the paper's matcher (graph_matcher.h).
enum class MatcherKind : uint8_t { kWall, kGraph };

struct LocalizerOptions {
  MatcherKind matcher_kind = MatcherKind::kWall;
  int derive_rooms_every = 3;      // keyframes between two tries of the matcher by rooms
  int optimize_every = 1;          // keyframes between two solves once localized: ...
  double solve_all_growth = 0.05;  // ... of everything when the map has grown by this share since the last of them, ...
  int window_keyframes = 20;       // ... else of the poses of so many newest keyframes; at most mapper.recent_keyframes
  int rescore_every = 10;          // keyframes between two re-scorings of the fix against its rivals and against "outside the plan"
  int lost_after = 2;              // as many re-scorings in a row that speak against the fix end it
  double rival_margin_nats = 5.0;  // a rival must be better by this much to count against the fix
  StartHint hint;                  // of the place where the first scan was taken; until the robot is carried off
  OdometryOptions odometry;
  MapperOptions mapper;
  MatcherOptions matcher;  // once found, a place is watched by rays whatever found it
  GraphMatcherOptions graph_matcher;
  CouplingOptions coupling;
  JointOptions joint;
  DeviationOptions deviations;
  UpdateSink on_update;              // updates while driving: those asked for and, ...
  bool update_every_solve =
      false;  // ... of itself, after every solve of everything and when the verdict changes. Doubles the time of these solves
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

}  // namespace plumb::runtime
