// Units of an IFC file: IfcUnitAssignment of the project, with SI prefixes and conversion-based units.
#pragma once

#include "compiler/frontends/ifc/ifc_model.h"

namespace plumb::compiler {

// Sets the model's length and angle units. What is missing is taken as metre or radian, with a diagnostic.
void ReadUnits(IfcModel& model);

}  // namespace plumb::compiler
