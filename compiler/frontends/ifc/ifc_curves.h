// IfcCurve as polylines: what profiles, sweeps and edges are made of. Metres.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "compiler/frontends/ifc/ifc_model.h"
#include "compiler/frontends/ifc/ifc_placement.h"
#include "compiler/geometry/triangulate.h"
#include "schema/agraph.h"

namespace plumb::compiler {

struct CurvePoints {
  Ring3 points;           // 2D curves at z = 0; a closed curve ends where it began
  std::vector<Arc> arcs;  // circular arcs that lie in the xy plane, exact
};

// Where a trimmed curve begins or ends.
struct CurveTrim {
  std::optional<double> parameter;
  std::optional<Eigen::Vector3d> point;
};

// A polygon of more corners would take triangulators and exact predicates minutes.
inline constexpr size_t kMaxCurvePoints = 100000;

class CurveReader {
 public:
  CurveReader(const IfcModel& model, const PlacementReader& placements, double chord_tolerance_m)
      : model_(model), placements_(placements), chord_tolerance_m_(chord_tolerance_m) {}

  // IfcPolyline, IfcIndexedPolyCurve, IfcCompositeCurve, IfcTrimmedCurve of lines, conics and splines, IfcCircle, IfcEllipse,
  // IfcBSplineCurveWithKnots. Empty, with an UnsupportedGeometry diagnostic, for others, and with PlanTooComplex beyond kMaxCurvePoints.
  [[nodiscard]] CurvePoints Read(const IfcInstance& curve) const { return Read(curve, 0); }
  // The points of a list of references; as for Read, `whole` is what they are of.
  [[nodiscard]] Ring3 Points(StepValue list, uint32_t whole) const;

  // The same without its repeated points and as a ring in the xy plane.
  [[nodiscard]] Ring2 ReadRing(const IfcInstance& curve, std::vector<Arc>* arcs) const;

  // The part of the curve between two points on it, from `start` to `end`: the edges of advanced faces. The whole curve where they are one.
  [[nodiscard]] Ring3 ReadBetween(const IfcInstance& edge_curve, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                                  bool same_sense) const;

  [[nodiscard]] std::vector<Eigen::Vector3d> PointList(const IfcInstance& list) const;  // IfcCartesianPointList2D and 3D

 private:
  [[nodiscard]] CurvePoints Read(const IfcInstance& curve, int depth) const;
  [[nodiscard]] bool TooLong(size_t points, uint32_t whole) const;
  [[nodiscard]] CurvePoints Composite(const IfcInstance& curve, int depth) const;
  [[nodiscard]] CurvePoints Trimmed(const IfcInstance& curve, int depth) const;
  [[nodiscard]] CurvePoints Indexed(const IfcInstance& curve) const;
  [[nodiscard]] CurvePoints Conic(const IfcInstance& conic, double start_rad, double sweep_rad) const;
  [[nodiscard]] CurvePoints Spline(const IfcInstance& curve, const CurveTrim& a, const CurveTrim& b) const;
  [[nodiscard]] double AngleOnConic(const IfcInstance& conic, const Eigen::Vector3d& p) const;
  void AddArcThrough(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, CurvePoints& out) const;

  const IfcModel& model_;
  const PlacementReader& placements_;
  double chord_tolerance_m_;
};

}  // namespace plumb::compiler
