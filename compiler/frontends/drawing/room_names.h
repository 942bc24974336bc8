// Names of rooms among the texts of a drawing.
#pragma once

#include <string>
#include <vector>

#include "compiler/frontends/drawing/drawing.h"

namespace plumb::compiler {

// The name that the texts within one face give, from top to bottom; empty: none of them is a name. Areas, dimensions, sizes of doors and
// notes on the drawing are no names; texts that the source states to name rooms are preferred, then the tallest ones.
[[nodiscard]] std::string RoomName(std::vector<const DrawnText*> texts);

}  // namespace plumb::compiler
