// Points, directions, placements and transformation operators of an IFC file as Eigen transforms. Metres.
#pragma once

#include <Eigen/Geometry>
#include <unordered_map>
#include <vector>

#include "compiler/frontends/ifc/ifc_grid.h"
#include "compiler/frontends/ifc/ifc_model.h"

namespace plumb::compiler {

enum class TripleStatus { kGood, kBad, kNotFinite };
// Up to three numbers of a list; what is not stated is zero.
[[nodiscard]] TripleStatus ReadTriple(StepValue list, Eigen::Vector3d& out);

class PlacementReader {
 public:
  explicit PlacementReader(const IfcModel& model) : model_(model), grids_(model), known_points_(kKnownPoints) {}

  // Zero for what is no point; a 2D point has z = 0.
  [[nodiscard]] Eigen::Vector3d Point(const IfcInstance& point) const;
  [[nodiscard]] Eigen::Vector3d Point(StepValue reference) const { return Point(model_.Follow(reference)); }
  // Not normalized. `fallback` where the reference is unset or (BadAttribute) the direction is no direction.
  [[nodiscard]] Eigen::Vector3d Direction(StepValue reference, const Eigen::Vector3d& fallback) const;

  // IfcAxis2Placement3D, or IfcAxis2Placement2D in the xy plane; the identity if unset.
  [[nodiscard]] Eigen::Isometry3d AxisPlacement(StepValue reference) const;
  // IfcObjectPlacement with all that it is relative to, to the plan frame. The identity if unset. Cycles and chains of over 200 placements
  // end with a ReferenceCycle diagnostic; placements over kMaxCoordinate_m from the origin are left out (BadAttribute). Cached.
  [[nodiscard]] Eigen::Isometry3d ObjectPlacement(StepValue reference);
  // IfcCartesianTransformationOperator, 2D or 3D, uniform or not.
  [[nodiscard]] Eigen::Affine3d Operator(StepValue reference) const;

 private:
  [[nodiscard]] IfcInstance ParentOf(const IfcInstance& placement) const;
  [[nodiscard]] Eigen::Isometry3d OwnPlacement(const IfcInstance& placement) const;
  [[nodiscard]] double Scale(const IfcInstance& op, size_t attribute_index, double fallback) const;

  // The faces around a corner name it one soon after the other: points read lately, each at its index modulo their number.
  struct KnownPoint {
    uint32_t index = StepFile::kNone;
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
  };
  static constexpr uint32_t kKnownPoints = 2048;

  const IfcModel& model_;
  GridReader grids_;
  mutable std::vector<KnownPoint> known_points_;
  std::unordered_map<uint32_t, Eigen::Isometry3d> T_plan_placement_;
};

}  // namespace plumb::compiler
