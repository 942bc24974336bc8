// Boundary representations of IFC: faceted and advanced breps, shells, face sets. Metres.
#pragma once

#include "compiler/frontends/ifc/ifc_curves.h"
#include "compiler/frontends/ifc/ifc_options.h"
#include "compiler/frontends/ifc/ifc_surfaces.h"
#include "compiler/geometry/solid.h"

namespace plumb::compiler {

class FaceReader {
 public:
  FaceReader(const IfcModel& model, const PlacementReader& placements, const CurveReader& curves, const IfcOptions& options)
      : model_(model),
        placements_(placements),
        curves_(curves),
        surfaces_(model, placements, curves, options.chord_tolerance_m),
        options_(options) {}

  // IfcClosedShell, IfcOpenShell, IfcConnectedFaceSet: welded, normals outward if it is closed.
  [[nodiscard]] Solid Shell(const IfcInstance& shell) const;
  // IfcFacetedBrep and IfcAdvancedBrep with or without voids.
  [[nodiscard]] Solid Brep(const IfcInstance& brep) const;
  // IfcTriangulatedFaceSet and IfcPolygonalFaceSet.
  [[nodiscard]] Solid FaceSet(const IfcInstance& face_set) const;

 private:
  void AppendIfcFace(const IfcInstance& face, Solid& solid) const;
  [[nodiscard]] Ring3 Loop(const IfcInstance& loop) const;
  [[nodiscard]] Ring3 EdgeLoop(const IfcInstance& loop) const;
  bool AppendCurvedFace(const IfcInstance& surface, const std::vector<Ring3>& rings, Solid& solid) const;
  void AppendTriangles(const IfcInstance& face_set, size_t point_count, Solid& solid) const;
  void AppendPolygons(const IfcInstance& face_set, const std::vector<Eigen::Vector3d>& points, Solid& solid) const;

  const IfcModel& model_;
  const PlacementReader& placements_;
  const CurveReader& curves_;
  SurfaceReader surfaces_;
  const IfcOptions& options_;
};

}  // namespace plumb::compiler
