// Outputs must not be written over what is read.
#pragma once

#include <string>
#include <vector>

#include "schema/error.h"

namespace plumb::tools {

struct OutputFlag {
  std::string flag, path;  // "--output", what it names; empty: not given
};

// An error if an output is one of the inputs, by whatever path.
[[nodiscard]] Expected<void> CheckOutputs(const std::vector<OutputFlag>& outputs, const std::vector<std::string>& inputs);

}  // namespace plumb::tools
