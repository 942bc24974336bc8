// Curved surfaces of advanced breps, unrolled into a plane so that faces on them can be triangulated. Metres.
#pragma once

#include <vector>

#include "compiler/frontends/ifc/ifc_curves.h"

namespace plumb::compiler {

struct UnrolledFace {
  std::vector<Ring2> rings;  // point for point those of the face; empty: the surface is of a type that is not read, or degenerate
  bool is_ruled = false;     // straight in one direction: triangles between its edges follow it
};

class SurfaceReader {
 public:
  SurfaceReader(const IfcModel& model, const PlacementReader& placements, const CurveReader& curves)
      : model_(model), placements_(placements), curves_(curves) {}

  // IfcCylindricalSurface, IfcSurfaceOfLinearExtrusion, IfcSurfaceOfRevolution, IfcBSplineSurfaceWithKnots. `rings`: the bounds of a face,
  // the outer one first. Rings that go round the surface go on beyond its seam. O(points of the rings * points of the surface).
  [[nodiscard]] UnrolledFace Unroll(const IfcInstance& surface, const std::vector<Ring3>& rings) const;

 private:
  const IfcModel& model_;
  const PlacementReader& placements_;
  const CurveReader& curves_;
};

}  // namespace plumb::compiler
