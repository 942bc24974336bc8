// The tries to find the map in the plan, as rows of hypotheses.json.
#pragma once

#include "runtime/localizer/graph_estimator.h"
#include "schema/agraph.h"
#include "tools/run/tries_json.h"

namespace plumb::tools {

// Places of less than a thousandth of the best one's probability are left out.
[[nodiscard]] TryRow ToRow(const AGraph& plan, const runtime::MatchTry& attempt);

}  // namespace plumb::tools
