// Writes .agraph files. The same A-Graph gives the same bytes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "schema/agraph.h"
#include "schema/error.h"

namespace plumb {

[[nodiscard]] std::vector<uint8_t> WriteAGraph(const AGraph& graph);

// Writes beside `path` and renames, so that no reader ever sees half a file. Errors: kFileUnwritable.
[[nodiscard]] Expected<void> WriteAGraphFile(const AGraph& graph, const std::string& path);

}  // namespace plumb
