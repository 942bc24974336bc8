// Where a file says that its plan lies on the Earth. The plan frame is the one before the map conversion: this only finds contradictions.
#pragma once

#include <Eigen/Core>

#include "compiler/frontends/ifc/ifc_model.h"

namespace plumb::compiler {

// For a plan that its placements put around `plan_origin_m`, far from zero: GeoreferencedTwice if its IfcMapConversion (in IFC2X3 the
// property set ePSet_MapConversion) leads to that place again, so that a reader who applies both would put it at twice its
// eastings and northings.
void CheckGeoreference(const IfcModel& model, const Eigen::Vector3d& plan_origin_m);

}  // namespace plumb::compiler
