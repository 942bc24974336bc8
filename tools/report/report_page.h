// The parts of the report's page that do not depend on the run.
#pragma once

#include <string>
#include <string_view>

namespace plumb::tools {

// Style of the page around the drawings, light and dark, on screen and on paper.
[[nodiscard]] std::string_view PageStyle();

// Exaggerates deviations, shows and hides layers. The page reads the same without it.
[[nodiscard]] std::string_view PageScript();

// Legend and controls above the drawings; `limit_m` is the end of the colour scale.
[[nodiscard]] std::string LegendHtml(double limit_m);

}  // namespace plumb::tools
