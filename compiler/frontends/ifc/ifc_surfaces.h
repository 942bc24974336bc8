// Curved surfaces of advanced breps, unrolled into a plane so that faces on them can be triangulated. Metres.
#pragma once

#include <vector>

#include "compiler/frontends/ifc/ifc_curves.h"

namespace plumb::compiler {

struct UnrolledFace {
  // The outer one first. Empty: the surface is of a type that is not read, degenerate, or takes more steps than a file of that size is
  // worth.
  std::vector<Ring2> rings;
  Ring3 points;           // of the rings, in space, one ring after the other
  bool is_ruled = false;  // straight in one direction: triangles between its edges follow it
};

class SurfaceReader {
 public:
  // Faces of splines that keep within `plane_tolerance_m` of a plane are taken as plane.
  SurfaceReader(const IfcModel& model, const PlacementReader& placements, const CurveReader& curves, double plane_tolerance_m)
      : model_(model), placements_(placements), curves_(curves), plane_tolerance_m_(plane_tolerance_m) {}

  // IfcCylindricalSurface, IfcSurfaceOfLinearExtrusion, IfcSurfaceOfRevolution, IfcBSplineSurfaceWithKnots. `rings`: the bounds of a face,
  // the outer one first. Rings that go round the surface go on beyond its seam. O(points of the rings * points of the surface), bounded by
  // IfcModel::SpendOnSurface.
  [[nodiscard]] UnrolledFace Unroll(const IfcInstance& surface, const std::vector<Ring3>& rings) const;

 private:
  const IfcModel& model_;
  const PlacementReader& placements_;
  const CurveReader& curves_;
  double plane_tolerance_m_;
};

}  // namespace plumb::compiler
