#include "compiler/frontends/ifc/ifc_placement.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

namespace plumb::compiler {
namespace {

using Eigen::Affine3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr size_t kMaxChain = 200;

// Right-handed axes with z along `axis` and x as close to `reference` as that allows.
Eigen::Matrix3d Frame(const Vector3d& axis, const Vector3d& reference) {
  const Vector3d z = axis.normalized();
  Vector3d x = reference - reference.dot(z) * z;
  if (x.norm() < 1e-9 * reference.norm()) {
    const Vector3d other = std::abs(z.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
    x = other - other.dot(z) * z;
  }
  x.normalize();
  Eigen::Matrix3d frame;
  frame << x, z.cross(x), z;
  return frame;
}

}  // namespace

TripleStatus ReadTriple(StepValue list, Vector3d& out) {
  out.setZero();
  int n = 0;
  for (const StepValue item : list.Items()) {
    if (n == 3) break;
    const auto number = item.Real();
    if (!number) return item.IsNotFinite() ? TripleStatus::kNotFinite : TripleStatus::kBad;
    out[n++] = *number;
  }
  return n > 0 ? TripleStatus::kGood : TripleStatus::kBad;
}

Vector3d PlacementReader::Point(const IfcInstance& point) const {
  if (!point) return Vector3d::Zero();
  KnownPoint& known = known_points_[point.index % kKnownPoints];
  if (known.index == point.index) return known.p;
  Vector3d p = Vector3d::Zero();
  DiagnosticKind problem = DiagnosticKind::kBadAttribute;
  if (point.type == IfcType::kIfcCartesianPoint) {
    const TripleStatus status = ReadTriple(point[attribute::kCoordinates], p);
    p *= model_.length_scale();
    if (status == TripleStatus::kGood && IsCoordinate(p)) {
      known = {point.index, p};
      return p;
    }
    if (status == TripleStatus::kNotFinite || !IsNumber(p)) problem = DiagnosticKind::kNumberNotFinite;
  }
  model_.Emit(problem, point.index,
              fmt::format("{} gives no coordinates within {} m; it is taken as the origin", model_.Label(point.index), kMaxCoordinate_m));
  return Vector3d::Zero();
}

Vector3d PlacementReader::Direction(StepValue reference, const Vector3d& fallback) const {
  const IfcInstance direction = model_.Follow(reference);
  if (!direction) return fallback;
  Vector3d d = Vector3d::Zero();
  const bool is_direction = direction.type == IfcType::kIfcDirection;
  const TripleStatus status = is_direction ? ReadTriple(direction[attribute::kDirectionRatios], d) : TripleStatus::kBad;
  const double largest = d.cwiseAbs().maxCoeff();
  // Only the ratios count: scaled so that no square overflows or vanishes.
  if (status == TripleStatus::kGood && largest > 1e-12) return largest > 1e12 ? Vector3d(d / largest) : d;
  const DiagnosticKind problem = status == TripleStatus::kNotFinite ? DiagnosticKind::kNumberNotFinite : DiagnosticKind::kBadAttribute;
  model_.Emit(problem, direction.index,
              fmt::format("{} has no length; the default direction is taken", model_.Label(direction.index)));
  return fallback;
}

Isometry3d PlacementReader::AxisPlacement(StepValue reference) const {
  Isometry3d T = Isometry3d::Identity();
  const IfcInstance placement = model_.Follow(reference);
  if (!placement) return T;
  const bool is_3d = placement.type == IfcType::kIfcAxis2Placement3D;
  if (!is_3d && placement.type != IfcType::kIfcAxis2Placement2D) return T;
  T.translation() = Point(placement[attribute::kLocation]);
  const Vector3d axis = is_3d ? Direction(placement[attribute::kAxis], Vector3d::UnitZ()) : Vector3d::UnitZ();
  T.linear() = Frame(axis, Direction(placement[is_3d ? attribute::kRefDirection3D : attribute::kRefDirection2D], Vector3d::UnitX()));
  return T;
}

IfcInstance PlacementReader::ParentOf(const IfcInstance& placement) const {
  if (placement.type == IfcType::kIfcGridPlacement) return grids_.ParentOf(placement);
  const bool says_so = placement.type == IfcType::kIfcLocalPlacement || placement.type == IfcType::kIfcLinearPlacement;
  return says_so ? model_.Follow(placement[attribute::kPlacementRelTo]) : IfcInstance();
}

Isometry3d PlacementReader::OwnPlacement(const IfcInstance& placement) const {
  if (placement.type == IfcType::kIfcLocalPlacement) return AxisPlacement(placement[attribute::kRelativePlacement]);
  if (placement.type == IfcType::kIfcLinearPlacement && !placement[attribute::kLinearCartesianPosition].is_null()) {
    return AxisPlacement(placement[attribute::kLinearCartesianPosition]);
  }
  if (placement.type == IfcType::kIfcGridPlacement) {
    if (const std::optional<Isometry3d> T = grids_.Read(placement, *this)) return *T;
  }
  model_.Emit(DiagnosticKind::kUnsupportedPlacement, placement.index,
              fmt::format("{} is not read; what it places stands at the origin of what it is relative to", model_.Label(placement.index)));
  return Isometry3d::Identity();
}

Isometry3d PlacementReader::ObjectPlacement(StepValue reference) {
  std::vector<IfcInstance> chain;
  Isometry3d T = Isometry3d::Identity();
  for (IfcInstance at = model_.Follow(reference); at;) {
    if (const auto known = T_plan_placement_.find(at.index); known != T_plan_placement_.end()) {
      T = known->second;
      break;
    }
    if (chain.size() == kMaxChain) {
      model_.Emit(DiagnosticKind::kReferenceCycle, at.index,
                  fmt::format("the placement {} is relative to itself or to more than {} others", model_.Label(at.index), kMaxChain));
      break;
    }
    chain.push_back(at);
    at = ParentOf(at);
  }
  for (auto it = chain.rbegin(); it != chain.rend(); ++it) {
    const Isometry3d T_next = T * OwnPlacement(*it);
    if (IsCoordinate(T_next.translation())) {
      T = T_next;
    } else {
      model_.Emit(DiagnosticKind::kBadAttribute, it->index,
                  fmt::format("the placement {} lies over {} m from the origin; what it places stands where it is relative to",
                              model_.Label(it->index), kMaxCoordinate_m));
    }
    T_plan_placement_.emplace(it->index, T);
  }
  return T;
}

double PlacementReader::Scale(const IfcInstance& op, size_t attribute_index, double fallback) const {
  constexpr double kMaxScale = 1e6;
  const double scale = model_.Number(op, attribute_index, fallback);
  if (std::abs(scale) <= kMaxScale && std::abs(scale) >= 1 / kMaxScale) return scale;
  model_.Emit(DiagnosticKind::kBadAttribute, op.index,
              fmt::format("the scale {} of {} is not within {} and {}; it is taken as {}", scale, model_.Label(op.index), 1 / kMaxScale,
                          kMaxScale, fallback));
  return fallback;
}

Affine3d PlacementReader::Operator(StepValue reference) const {
  Affine3d T = Affine3d::Identity();
  const IfcInstance op = model_.Follow(reference);
  if (!op) return T;
  const bool is_2d =
      op.type == IfcType::kIfcCartesianTransformationOperator2D || op.type == IfcType::kIfcCartesianTransformationOperator2DnonUniform;
  const double scale = Scale(op, attribute::kOperatorScale, 1);
  Vector3d scales = Vector3d::Constant(scale);
  if (op.type == IfcType::kIfcCartesianTransformationOperator3DnonUniform) {
    scales.y() = Scale(op, attribute::kOperatorScale2, scale);
    scales.z() = Scale(op, attribute::kOperatorScale3, scale);
  } else if (op.type == IfcType::kIfcCartesianTransformationOperator2DnonUniform) {
    scales.y() = Scale(op, attribute::kOperatorScale2In2D, scale);
  }
  const Vector3d axis3 = is_2d ? Vector3d::UnitZ() : Direction(op[attribute::kOperatorAxis3], Vector3d::UnitZ());
  Eigen::Matrix3d frame = Frame(axis3, Direction(op[attribute::kOperatorAxis1], Vector3d::UnitX()));
  // Axis2 only chooses the side: against the frame's y it mirrors.
  if (Direction(op[attribute::kOperatorAxis2], frame.col(1)).dot(frame.col(1)) < 0) frame.col(1) = -frame.col(1);
  T.linear() = frame * scales.asDiagonal();
  T.translation() = Point(op[attribute::kOperatorOrigin]);
  return T;
}

}  // namespace plumb::compiler
