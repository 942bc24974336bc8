// Plans far from zero, as surveyors place them, moved near it.
#pragma once

#include "compiler/ir/plan_ir.h"

namespace plumb::compiler {

// If the plan's walls lie farther than `far_origin_m` from zero along an axis, subtracts their middle in whole metres from every coordinate
// and keeps it in PlanIr::origin. z stays unless it is as far. True: moved.
bool MoveNearZero(double far_origin_m, PlanIr& plan);

}  // namespace plumb::compiler
