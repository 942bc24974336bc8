// The storeys of an IFC file, by height.
#pragma once

#include <vector>

#include "compiler/frontends/ifc/ifc_placement.h"
#include "compiler/frontends/ifc/ifc_relations.h"
#include "compiler/ir/plan_ir.h"

namespace plumb::compiler {

class StoreyTable {
 public:
  // Sorted by elevation.
  [[nodiscard]] std::vector<PlanStorey> Read(const IfcModel& model, PlacementReader& placements);
  // Where in that order the IfcBuildingStorey `instance` is; kNoIndex for StepFile::kNone.
  [[nodiscard]] uint32_t Of(uint32_t instance) const { return position_of_[instance]; }

 private:
  InstanceMap position_of_;
};

}  // namespace plumb::compiler
