// The report: one HTML page that needs nothing else, neither network nor scripts to be read.
#pragma once

#include <string>

#include "schema/agraph.h"
#include "schema/error.h"
#include "tools/run/run_folder.h"
#include "tools/run/run_info.h"

namespace plumb::tools {

// Errors: kBadRunFolder (the run names a surface or room that this plan does not have). Same input, same bytes.
[[nodiscard]] Expected<std::string> RunToHtml(const AGraph& plan, const Run& run, const RunInfo& info);

}  // namespace plumb::tools
