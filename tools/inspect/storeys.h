// Which storey is meant.
#pragma once

#include <string>

#include "schema/agraph.h"
#include "schema/error.h"

namespace plumb::tools {

// By name (in any case and without accents, if only one is called so) or by number, counted from 0. Errors: kBadOption, with the storeys
// that there are.
[[nodiscard]] Expected<StoreyId> FindStorey(const AGraph& graph, const std::string& name_or_number);

// The one with the most rooms, the lower of equal ones; none in a plan without storeys.
[[nodiscard]] StoreyId MainStorey(const AGraph& graph);

}  // namespace plumb::tools
