// Messages of options' checks in the words of the command line.
#pragma once

#include <string>

namespace plumb::tools {

// "MeshOptions.unit = x; must be ..." -> "--unit x; must be ...". Fields without a flag stay as they are.
[[nodiscard]] std::string InFlags(const std::string& fault);

}  // namespace plumb::tools
