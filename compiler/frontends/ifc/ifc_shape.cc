#include "compiler/frontends/ifc/ifc_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "compiler/frontends/ifc/ifc_primitives.h"
#include "compiler/frontends/ifc/ifc_representations.h"
#include "compiler/geometry/sweep.h"

namespace plumb::compiler {
namespace {

using Eigen::Affine3d;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMaxDepth = 300;
constexpr int kMinDiskSides = 8;

size_t CountTriangles(const ShapeParts& parts) {
  size_t n = 0;
  for (const ShapePart& part : parts) n += part.solid.triangles.size();
  return n;
}

ShapeParts OnePart(Solid solid) {
  ShapeParts parts;
  if (!solid.empty()) parts.emplace_back(std::move(solid), Look::kUnstated);
  return parts;
}

bool IsBoolean(IfcType type) { return type == IfcType::kIfcBooleanResult || type == IfcType::kIfcBooleanClippingResult; }

}  // namespace

void TransformPart(const Affine3d& T_out_part, ShapePart& part) {
  TransformSolid(T_out_part, part.solid);
  part.T_part_profile = T_out_part * part.T_part_profile;
}

void KeepInRange(const IfcModel& model, uint32_t instance, ShapeParts& parts) {
  const auto is_out = [](const ShapePart& part) {
    return !std::all_of(part.solid.vertices.begin(), part.solid.vertices.end(), IsCoordinate);
  };
  if (std::erase_if(parts, is_out) == 0) return;
  model.Emit(DiagnosticKind::kBadAttribute, instance,
             fmt::format("parts of {} reach over {} m from the origin; they are left out", model.Label(instance), kMaxCoordinate_m));
}

ShapeReader::ShapeReader(const IfcModel& model, const PlacementReader& placements, const StyleReader& styles, const IfcOptions& options)
    : model_(model),
      placements_(placements),
      styles_(styles),
      options_(options),
      curves_(model, placements, options.chord_tolerance_m),
      profiles_(model, placements, curves_, options.chord_tolerance_m),
      faces_(model, placements, curves_, options_),
      booleans_(model, placements, curves_, options_) {
  for (const uint32_t item : model.InstancesOf(IfcType::kIfcMappedItem)) {
    const auto map = model.Get(item)[attribute::kMappingSource].Reference();
    if (map) ++map_items_left_[model.file().Find(*map)];
  }
}

ShapeParts ShapeReader::Body(const IfcInstance& definition_shape) {
  for (const BodyRepresentation& body : BodyRepresentations(model_, definition_shape)) {
    ShapeParts parts = Representation(body.representation, 0);
    if (parts.empty()) continue;
    if (body.is_box) {
      model_.Emit(DiagnosticKind::kBoundingBoxInstead, definition_shape.index,
                  fmt::format("{} has no body that can be read; its bounding box stands for it", model_.Label(definition_shape.index)));
    }
    return parts;
  }
  return {};
}

std::optional<std::pair<Vector3d, Vector3d>> ShapeReader::Axis(const IfcInstance& definition_shape) const {
  for (const IfcInstance& curve : AxisCurves(model_, definition_shape)) {
    const CurvePoints points = curves_.Read(curve);
    if (points.points.size() >= 2) return std::make_pair(points.points.front(), points.points.back());
  }
  return std::nullopt;
}

bool ShapeReader::TooLarge(const ShapeParts& parts, uint32_t whole) const {
  if (CountTriangles(parts) <= options_.max_triangles_per_element) return false;
  model_.Emit(DiagnosticKind::kTooManyTriangles, whole,
              fmt::format("{} has over {} triangles; the rest is left out", model_.Label(whole), options_.max_triangles_per_element));
  return true;
}

ShapeParts ShapeReader::Representation(const IfcInstance& representation, int depth) {
  ShapeParts parts;
  for (const StepValue reference : representation[attribute::kRepresentationItems].Items()) {
    const IfcInstance item = model_.Follow(reference);
    if (!item) continue;
    ShapeParts more = Item(item, depth);
    parts.insert(parts.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
    if (TooLarge(parts, representation.index)) break;
  }
  return parts;
}

ShapeParts ShapeReader::Item(const IfcInstance& item, int depth) {
  if (depth > kMaxDepth) {
    model_.Emit(DiagnosticKind::kReferenceCycle, item.index,
                fmt::format("the shape {} contains itself or is nested more than {} deep", model_.Label(item.index), kMaxDepth));
    return {};
  }
  if (!model_.Spend(1, item.index)) return {};
  ShapeParts parts = ReadItem(item, depth);
  ApplyLook(item, parts);
  return parts;
}

// A style on the whole holds where the parts state none of their own.
void ShapeReader::ApplyLook(const IfcInstance& item, ShapeParts& parts) const {
  const Look look = styles_.OfItem(item.index);
  if (look == Look::kUnstated) return;
  for (ShapePart& part : parts) {
    if (part.look == Look::kUnstated) part.look = look;
  }
}

ShapeParts ShapeReader::ReadItem(const IfcInstance& item, int depth) {
  switch (item.type) {
    case IfcType::kIfcExtrudedAreaSolid:
    case IfcType::kIfcExtrudedAreaSolidTapered: return Extruded(item);
    case IfcType::kIfcRevolvedAreaSolid: return Revolved(item);
    case IfcType::kIfcSweptDiskSolid:
    case IfcType::kIfcSweptDiskSolidPolygonal: return Disk(item);
    case IfcType::kIfcBooleanResult:
    case IfcType::kIfcBooleanClippingResult: return Boolean(item, depth);
    case IfcType::kIfcCsgSolid: {
      const IfcInstance tree = model_.Follow(item[attribute::kCsgTree]);
      return tree ? Item(tree, depth + 1) : ShapeParts();
    }
    case IfcType::kIfcBlock:
    case IfcType::kIfcRectangularPyramid:
    case IfcType::kIfcRightCircularCone:
    case IfcType::kIfcRightCircularCylinder:
    case IfcType::kIfcSphere: return Primitive(item);
    case IfcType::kIfcFacetedBrep:
    case IfcType::kIfcFacetedBrepWithVoids:
    case IfcType::kIfcAdvancedBrep:
    case IfcType::kIfcAdvancedBrepWithVoids: return OnePart(faces_.Brep(item));
    case IfcType::kIfcFaceBasedSurfaceModel:
    case IfcType::kIfcShellBasedSurfaceModel: return SurfaceModel(item);
    case IfcType::kIfcConnectedFaceSet:
    case IfcType::kIfcClosedShell:
    case IfcType::kIfcOpenShell: return OnePart(faces_.Shell(item));
    case IfcType::kIfcTriangulatedFaceSet:
    case IfcType::kIfcTriangulatedIrregularNetwork:
    case IfcType::kIfcPolygonalFaceSet: return OnePart(faces_.FaceSet(item));
    case IfcType::kIfcMappedItem: return Mapped(item, depth);
    case IfcType::kIfcBoundingBox: return OnePart(BoundingBox(item));
    case IfcType::kIfcGeometricSet:
    case IfcType::kIfcGeometricCurveSet:
    case IfcType::kIfcPolyline: return {};  // lines have no body
    default: break;
  }
  model_.Emit(DiagnosticKind::kUnsupportedGeometry, item.index,
              fmt::format("the shape {} is of a type that is not read", model_.Label(item.index)));
  return {};
}

ShapeParts ShapeReader::Mapped(const IfcInstance& item, int depth) {
  const IfcInstance map = model_.Follow(item[attribute::kMappingSource]);
  if (!map || map.type != IfcType::kIfcRepresentationMap) return {};
  // Entered before it is read, so that a map within itself is met here, not at the end of an exponential descent.
  const auto [known, fresh] = mapped_.try_emplace(map.index);
  std::optional<ShapeParts>& known_parts = known->second;  // stays where it is when the table grows
  if (!fresh && !known_parts) {
    model_.Emit(DiagnosticKind::kReferenceCycle, item.index, fmt::format("the shape {} contains itself", model_.Label(map.index)));
    return {};
  }
  if (fresh) {
    const IfcInstance representation = model_.Follow(map[attribute::kMappedRepresentation]);
    ShapeParts parts;
    if (representation) parts = Representation(representation, depth + 1);
    const Affine3d T_map_origin(placements_.AxisPlacement(map[attribute::kMapOrigin]).matrix());
    for (ShapePart& part : parts) TransformPart(T_map_origin, part);
    known_parts = std::move(parts);
  }
  // What nothing refers to any more is handed on, not copied; should it be, in a round-about way, it is read once more and then stays.
  size_t& items_left = map_items_left_[map.index];
  const bool is_last = items_left > 0 && --items_left == 0;
  ShapeParts parts;
  if (is_last) {
    parts = std::move(*known_parts);
    mapped_.erase(map.index);
  } else {
    parts = *known_parts;
  }
  const Affine3d T = placements_.Operator(item[attribute::kMappingTarget]);
  for (ShapePart& part : parts) TransformPart(T, part);
  KeepInRange(model_, item.index, parts);
  return parts;
}

ShapeParts ShapeReader::Extruded(const IfcInstance& item) {
  const Profile profile = profiles_.Read(model_.Follow(item[attribute::kSweptArea]));
  if (profile.area.empty()) return {};
  const Vector3d direction = placements_.Direction(item[attribute::kExtrudedDirection], Vector3d::UnitZ()).normalized();
  const Vector3d offset = direction * model_.Length(item, attribute::kExtrusionDepth);
  ShapePart part;
  if (item.type == IfcType::kIfcExtrudedAreaSolidTapered) {
    part.solid = Loft(profile.area, profiles_.Read(model_.Follow(item[attribute::kEndSweptArea])).area, offset);
    if (part.solid.empty()) {
      model_.Emit(DiagnosticKind::kSimplifiedGeometry, item.index,
                  fmt::format("the end profile of {} does not fit to its start; it is extruded straight", model_.Label(item.index)));
    }
  }
  if (part.solid.empty()) part.solid = Extrude(profile.area, offset);
  if (part.solid.empty()) {
    model_.Emit(DiagnosticKind::kDegenerateGeometry, item.index,
                fmt::format("{} encloses nothing: its profile or its depth is empty", model_.Label(item.index)));
    return {};
  }
  part.arcs = profile.arcs;
  TransformPart(Affine3d(placements_.AxisPlacement(item[attribute::kSweptPosition]).matrix()), part);
  return {std::move(part)};
}

ShapeParts ShapeReader::Revolved(const IfcInstance& item) {
  const Profile profile = profiles_.Read(model_.Follow(item[attribute::kSweptArea]));
  const IfcInstance axis = model_.Follow(item[attribute::kRevolutionAxis]);
  if (profile.area.empty() || !axis) return {};
  const Vector3d point = placements_.Point(axis[attribute::kLocation]);
  const Vector3d direction = placements_.Direction(axis[attribute::kAxis], Vector3d::UnitY());
  const double angle_rad =
      std::clamp(model_.Number(item, attribute::kRevolutionAngle) * model_.angle_scale(), -2 * std::numbers::pi, 2 * std::numbers::pi);
  double reach_m = 0;
  for (const Ring2& ring : profile.area) {
    for (const Vector2d& p : ring) reach_m = std::max(reach_m, (p - point.head<2>()).norm());
  }
  Solid solid =
      Revolve(profile.area, point.head<2>(), direction.head<2>(), angle_rad, ArcSegments(reach_m, angle_rad, options_.chord_tolerance_m));
  if (solid.empty()) {
    model_.Emit(DiagnosticKind::kDegenerateGeometry, item.index,
                fmt::format("{} encloses nothing: its profile or its angle is empty", model_.Label(item.index)));
  }
  TransformSolid(Affine3d(placements_.AxisPlacement(item[attribute::kSweptPosition]).matrix()), solid);
  return OnePart(std::move(solid));
}

ShapeParts ShapeReader::Disk(const IfcInstance& item) {
  const CurvePoints path = curves_.Read(model_.Follow(item[attribute::kDirectrix]));
  const double radius_m = model_.Length(item, attribute::kDiskRadius);
  return OnePart(SweepDisk(path.points, radius_m, ArcSegments(radius_m, 2 * std::numbers::pi, options_.chord_tolerance_m, kMinDiskSides)));
}

ShapeParts ShapeReader::Primitive(const IfcInstance& item) {
  Solid solid = ReadPrimitive(model_, item, options_.chord_tolerance_m);
  if (solid.empty()) {
    model_.Emit(DiagnosticKind::kDegenerateGeometry, item.index,
                fmt::format("{} has measures that are not positive", model_.Label(item.index)));
  }
  TransformSolid(Affine3d(placements_.AxisPlacement(item[attribute::kPrimitivePosition]).matrix()), solid);
  return OnePart(std::move(solid));
}

ShapeParts ShapeReader::SurfaceModel(const IfcInstance& item) {
  Solid solid;
  size_t shells = 0;
  for (const StepValue shell : item[attribute::kModelShells].Items()) {
    AppendSolid(faces_.Shell(model_.Follow(shell)), solid);
    ++shells;
  }
  // Shells that only close together are one solid.
  if (shells > 1 && !IsClosed(solid)) {
    WeldSolid(options_.weld_tolerance_m, solid);
    OrientOutward(solid);
  }
  return OnePart(std::move(solid));
}

Solid ShapeReader::BoundingBox(const IfcInstance& item) const {
  const Vector3d corner = placements_.Point(item[attribute::kBoxCorner]);
  const Vector3d size(model_.Length(item, attribute::kBoxX), model_.Length(item, attribute::kBoxY), model_.Length(item, attribute::kBoxZ));
  return size.minCoeff() > 0 ? MakeBox(corner, corner + size) : Solid();
}

// Programs cut a wall by a chain of results, each the first operand of the next: as long as the wall has cuts, so it takes no stack.
ShapeParts ShapeReader::Boolean(const IfcInstance& item, int depth) {
  const size_t longest =
      model_.InstancesOf(IfcType::kIfcBooleanResult).size() + model_.InstancesOf(IfcType::kIfcBooleanClippingResult).size();
  std::vector<IfcInstance> chain;
  IfcInstance at = item;
  for (; at && IsBoolean(at.type); at = model_.Follow(at[attribute::kFirstOperand])) {
    if (chain.size() == longest) {
      model_.Emit(DiagnosticKind::kReferenceCycle, at.index, fmt::format("the shape {} contains itself", model_.Label(at.index)));
      return {};
    }
    chain.push_back(at);
  }
  if (!at) return {};
  ShapeParts parts = Item(at, depth + 1);
  for (auto it = chain.rbegin(); it != chain.rend() && !parts.empty(); ++it) {
    Combine(*it, depth, parts);
    if (it + 1 != chain.rend()) ApplyLook(*it, parts);  // Item does it for the last
  }
  return parts;
}

void ShapeReader::Combine(const IfcInstance& item, int depth, ShapeParts& parts) {
  const IfcInstance second = model_.Follow(item[attribute::kSecondOperand]);
  if (!second || !model_.Spend(1 + CountTriangles(parts), item.index)) return;
  const std::string_view op = item[attribute::kBooleanOperator].Enumeration();
  if (IsHalfSpace(second.type)) {
    if (op == "UNION") {
      model_.Emit(DiagnosticKind::kUnsupportedGeometry, item.index,
                  fmt::format("{} joins a half space, which has no end; it is left out", model_.Label(item.index)));
    } else {
      booleans_.CutByHalfSpace(second, item.index, op == "INTERSECTION", parts);
    }
    return;
  }
  if (TooLarge(parts, item.index)) return;
  ShapeParts tools = Item(second, depth + 1);
  if (op == "UNION") {
    parts.insert(parts.end(), std::make_move_iterator(tools.begin()), std::make_move_iterator(tools.end()));
  } else if (op == "INTERSECTION") {
    booleans_.Intersect(tools, item.index, parts);
  } else {
    booleans_.Subtract(tools, item.index, parts);
  }
}

}  // namespace plumb::compiler
