// PlanIr as JSON that reads back: a plan without a frontend for the tests of passes, and a look at what a frontend read.
#pragma once

#include <string>

#include "compiler/ir/plan_ir.h"
#include "schema/error.h"

namespace plumb::compiler {

// Full precision; fields with their default value are left out. Same plan, same text.
[[nodiscard]] std::string PlanIrToJson(const PlanIr& plan);

// Errors: kFileUnreadable for text that is no JSON or no such object. The plan may still break VerifyPlanIr.
[[nodiscard]] Expected<PlanIr> PlanIrFromJson(const std::string& text);

}  // namespace plumb::compiler
