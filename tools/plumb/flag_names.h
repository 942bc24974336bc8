// Messages of options' checks in the words of the command line.
#pragma once

#include <string>

namespace plumb::tools {

// "MeshOptions.unit = x; must be ..." -> "--unit x; must be ...". Fields without a flag stay as they are. Other fields of
// the same options become flags as well: "sill_m < window_top_m" -> "--sill-height < --window-top".
[[nodiscard]] std::string InFlags(const std::string& fault);

}  // namespace plumb::tools
