// Boolean operations of IFC on the parts of a shape. Metres. A cut that fails is left out, with a BooleanFailed diagnostic.
#pragma once

#include "compiler/frontends/ifc/ifc_curves.h"
#include "compiler/frontends/ifc/ifc_options.h"
#include "compiler/frontends/ifc/ifc_shape_part.h"

namespace plumb::compiler {

[[nodiscard]] bool IsHalfSpace(IfcType type);

class BooleanCutter {
 public:
  // What is passed must outlive the cutter.
  BooleanCutter(const IfcModel& model, const PlacementReader& placements, const CurveReader& curves, const IfcOptions& options)
      : model_(model), placements_(placements), curves_(curves), options_(options) {}

  // `result` is the instance that diagnostics are about. Parts of which nothing is left are dropped.
  void Subtract(const ShapeParts& tools, uint32_t result, ShapeParts& parts) const;
  void Intersect(const ShapeParts& tools, uint32_t result, ShapeParts& parts) const;
  // Takes away what lies within the half space, or all else.
  void CutByHalfSpace(const IfcInstance& half_space, uint32_t result, bool keep_inside, ShapeParts& parts) const;

 private:
  const IfcModel& model_;
  const PlacementReader& placements_;
  const CurveReader& curves_;
  const IfcOptions& options_;
};

}  // namespace plumb::compiler
