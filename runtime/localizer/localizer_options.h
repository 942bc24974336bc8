// Options of the localizer and all its stages.
#pragma once

#include <string>

#include "runtime/coupling/coupling.h"
#include "runtime/deviations/deviations.h"
#include "runtime/mapping/mapper_options.h"
#include "runtime/matching/matcher.h"
#include "runtime/odometry/odometry.h"
#include "runtime/optimization/joint_optimizer.h"

namespace plumb::runtime {

struct LocalizerOptions {
  int optimize_every = 1;          // keyframes between two joint solves once localized
  int rescore_every = 10;          // keyframes between two re-scorings of the fix against its rivals and against "outside the plan"
  int lost_after = 2;              // as many re-scorings in a row that speak against the fix end it
  double rival_margin_nats = 5.0;  // a rival must be better by this much to count against the fix
  OdometryOptions odometry;
  MapperOptions mapper;
  MatcherOptions matcher;
  CouplingOptions coupling;
  JointOptions joint;
  DeviationOptions deviations;
  [[nodiscard]] std::string Check() const;  // empty, or the field, its value and the rule
};

}  // namespace plumb::runtime
