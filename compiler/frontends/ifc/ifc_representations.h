// Which representations of a product show its body, and which its axis.
#pragma once

#include <vector>

#include "compiler/frontends/ifc/ifc_model.h"

namespace plumb::compiler {

struct BodyRepresentation {
  IfcInstance representation;
  bool is_box = false;  // no more than its bounding box
};

// Of an IfcProductDefinitionShape, those that serve best first.
[[nodiscard]] std::vector<BodyRepresentation> BodyRepresentations(const IfcModel& model, const IfcInstance& definition_shape);

// The first item of each Axis representation of an IfcProductDefinitionShape, if it is a curve.
[[nodiscard]] std::vector<IfcInstance> AxisCurves(const IfcModel& model, const IfcInstance& definition_shape);

}  // namespace plumb::compiler
