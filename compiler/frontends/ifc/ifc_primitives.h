// IfcCsgPrimitive3D as solids. Metres, in the primitive's own position.
#pragma once

#include "compiler/frontends/ifc/ifc_model.h"
#include "compiler/geometry/solid.h"

namespace plumb::compiler {

// IfcBlock, IfcRectangularPyramid, IfcRightCircularCone, IfcRightCircularCylinder, IfcSphere: closed, normals outward; round ones with
// their corners on the surface and chords within `chord_tolerance_m` of it. Empty if a measure is not positive.
[[nodiscard]] Solid ReadPrimitive(const IfcModel& model, const IfcInstance& item, double chord_tolerance_m);

}  // namespace plumb::compiler
