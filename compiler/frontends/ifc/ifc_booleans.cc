#include "compiler/frontends/ifc/ifc_booleans.h"

#include <fmt/format.h>

#include <utility>

#include "compiler/geometry/csg.h"
#include "compiler/geometry/sweep.h"

namespace plumb::compiler {
namespace {

using Eigen::Affine3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

}  // namespace

bool IsHalfSpace(IfcType type) {
  return type == IfcType::kIfcHalfSpaceSolid || type == IfcType::kIfcPolygonalBoundedHalfSpace || type == IfcType::kIfcBoxedHalfSpace;
}

void BooleanCutter::Subtract(const ShapeParts& tools, uint32_t result, ShapeParts& parts) const {
  const CsgOptions csg{.plane_epsilon_m = options_.plane_epsilon_m};
  for (ShapePart& part : parts) {
    for (const ShapePart& tool : tools) {
      Expected<Solid> rest = compiler::Subtract(part.solid, tool.solid, csg);
      if (rest) {
        part.solid = std::move(*rest);
      } else {
        model_.Emit(DiagnosticKind::kBooleanFailed, result, fmt::format("{} is left out: {}", model_.Label(result), rest.error().message));
      }
    }
  }
  std::erase_if(parts, [](const ShapePart& part) { return part.solid.empty(); });
}

// a and b = a - (a - b).
void BooleanCutter::Intersect(const ShapeParts& tools, uint32_t result, ShapeParts& parts) const {
  ShapeParts outside = parts;
  Subtract(tools, result, outside);
  Subtract(outside, result, parts);
}

void BooleanCutter::CutByHalfSpace(const IfcInstance& half_space, uint32_t result, bool keep_inside, ShapeParts& parts) const {
  const IfcInstance plane = model_.Follow(half_space[attribute::kHalfSpaceSurface]);
  if (!plane || plane.type != IfcType::kIfcPlane) {
    model_.Emit(DiagnosticKind::kUnsupportedGeometry, half_space.index,
                fmt::format("the half space {} is not bounded by a plane; the cut is left out", model_.Label(half_space.index)));
    return;
  }
  const Isometry3d T_plane = placements_.AxisPlacement(plane[attribute::kSurfacePosition]);
  // AgreementFlag true: the plane's normal points out of the half space's material.
  const bool agreement = half_space[attribute::kHalfSpaceAgreement].Boolean().value_or(true);
  const Vector3d n = agreement ? Vector3d(T_plane.linear().col(2)) : Vector3d(-T_plane.linear().col(2));
  const double d_m = -n.dot(T_plane.translation());
  const CsgOptions csg{.plane_epsilon_m = options_.plane_epsilon_m};
  const bool bounded = half_space.type == IfcType::kIfcPolygonalBoundedHalfSpace;
  Ring2 boundary;
  Isometry3d T_boundary = Isometry3d::Identity();
  if (bounded) {
    boundary = curves_.ReadRing(model_.Follow(half_space[attribute::kBoundedBoundary]), nullptr);
    T_boundary = placements_.AxisPlacement(half_space[attribute::kBoundedPosition]);
  }
  for (ShapePart& part : parts) {
    Expected<Solid> rest = Solid();
    if (bounded) {
      // The prism over the boundary, as long as the part, cut by the plane.
      Eigen::AlignedBox3d box;
      for (const Vector3d& v : part.solid.vertices) box.extend(T_boundary.inverse() * v);
      const double low_m = box.min().z() - 1, high_m = box.max().z() + 1;
      Solid prism = Extrude({boundary}, Vector3d::UnitZ() * (high_m - low_m));
      TransformSolid(Affine3d(T_boundary.matrix()) * Eigen::Translation3d(0, 0, low_m), prism);
      rest = CutByPlane(prism, n, d_m, csg);
      if (rest) rest = compiler::Subtract(part.solid, *rest, csg);
      if (rest && keep_inside) rest = compiler::Subtract(part.solid, *rest, csg);
    } else {
      rest = keep_inside ? CutByPlane(part.solid, n, d_m, csg) : CutByPlane(part.solid, -n, -d_m, csg);
    }
    if (rest) {
      part.solid = std::move(*rest);
    } else {
      model_.Emit(DiagnosticKind::kBooleanFailed, result, fmt::format("{} is left out: {}", model_.Label(result), rest.error().message));
    }
  }
  std::erase_if(parts, [](const ShapePart& part) { return part.solid.empty(); });
}

}  // namespace plumb::compiler
