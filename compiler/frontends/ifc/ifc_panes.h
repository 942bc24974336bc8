// Panes of windows for which no style tells glass from frame.
#pragma once

#include <vector>

#include "compiler/frontends/ifc/ifc_options.h"
#include "compiler/frontends/ifc/ifc_shape.h"

namespace plumb::compiler {

// Splits the parts of a window, in the plan frame, into their connected pieces and marks as glass those that are upright panels: thin,
// filled and of some size. Does nothing if a part is glass already.
void MarkPanes(const IfcOptions& options, ShapeParts& parts);

}  // namespace plumb::compiler
