// Proxies (IfcBuildingElementProxy) that act as walls: programs write what they have no class for as a proxy, walls among it.
#pragma once

#include <string_view>

#include "compiler/frontends/ifc/ifc_shape.h"

namespace plumb::compiler {

// A word of the name is one for wall in a language that plans are drawn in; "wall" but not "wallpaper".
[[nodiscard]] bool IsWallName(std::string_view name);

// The body stands upright, as high as a wall and much longer than thick.
[[nodiscard]] bool IsWallShaped(const ShapeParts& parts);

}  // namespace plumb::compiler
