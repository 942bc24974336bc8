#include "compiler/frontends/ifc/ifc_doors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace plumb::compiler {
namespace {

using Eigen::Affine3d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kMaxDepth = 8;
constexpr size_t kMaxSwings = 256;  // in one door; mapped items can multiply them without bound
constexpr double kMinSwing_rad = std::numbers::pi / 6, kMaxSwing_rad = 2 * std::numbers::pi / 3;  // of a leaf, from closed to open
constexpr double kFlat = 0.02;                                                                    // what a swing may rise of its radius

// Seen from above, in the plan; zero for what does not lie in it.
Vector2d Flat(const Matrix3d& R, const Vector3d& axis) {
  const Vector3d out = (R * axis).normalized();
  return out.head<2>().norm() > 0.7 ? Vector2d(out.head<2>().normalized()) : Vector2d(Vector2d::Zero());
}

// Fills in what is not stated from the leaf that is drawn at the same jamb.
std::vector<FramedLeaf> Joined(std::vector<FramedLeaf> stated, const std::vector<FramedLeaf>& drawn) {
  if (stated.empty()) return drawn;
  for (FramedLeaf& s : stated) {
    for (const FramedLeaf& d : drawn) {
      if (s.at_x == d.at_x && s.width_m == 0 && s.operation != LeafOperation::kFixed) s.width_m = d.width_m;
    }
  }
  return stated;
}

}  // namespace

std::vector<PlanLeaf> DoorReader::Leaves(uint32_t door_index) const {
  const IfcInstance door = model_.Get(door_index);
  const uint32_t type_index = relations_.TypeOf(door_index);
  const IfcInstance type = type_index == StepFile::kNone ? IfcInstance() : model_.Get(type_index);
  const double width_m = model_.Length(door, attribute::kOverallWidth);
  const Matrix3d R_plan_door = placements_.ObjectPlacement(door[attribute::kPlacement]).linear();
  std::vector<PlanLeaf> out;
  for (const FramedLeaf& leaf : Joined(Stated(door, type, width_m), Drawn(door, width_m))) {
    out.push_back({leaf.operation, leaf.at_x * Flat(R_plan_door, Vector3d::UnitX()), leaf.opens_to_y * Flat(R_plan_door, Vector3d::UnitY()),
                   leaf.width_m});
  }
  return out;
}

std::vector<FramedLeaf> DoorReader::Stated(const IfcInstance& door, const IfcInstance& type, double door_width_m) const {
  const auto read = [](const IfcInstance& of, size_t operation, size_t words) {
    const std::vector<FramedLeaf> by_name = LeavesByOperation(of[operation].Enumeration());
    return by_name.empty() && words != 0 ? LeavesByWords(of[words].Text()) : by_name;
  };
  std::vector<FramedLeaf> out = read(door, attribute::kDoorOperation, attribute::kDoorUserDefinedOperation);
  const bool by_type = out.empty() && type;
  if (by_type && type.type == IfcType::kIfcDoorType)
    out = read(type, attribute::kDoorTypeOperation, attribute::kDoorTypeUserDefinedOperation);
  if (by_type && type.type == IfcType::kIfcDoorStyle) out = read(type, attribute::kDoorStyleOperation, 0);
  if (!type || out.empty()) return out;
  const Matrix3d R_door_type = FrameOfType(door, type);
  AddPanelWidths(type, door_width_m, !by_type && R_door_type(0, 0) < 0, out);
  if (!by_type) return out;
  for (FramedLeaf& leaf : out) {
    leaf.at_x = static_cast<int>(std::lround((R_door_type * Vector3d(leaf.at_x, 0, 0)).normalized().x()));
    leaf.opens_to_y = static_cast<int>(std::lround((R_door_type * Vector3d(0, leaf.opens_to_y, 0)).normalized().y()));
  }
  return out;
}

// Two leaves may be unequal: each of the type's IfcDoorPanelProperties states the share of one. They need not add up to one, as some
// programs count the frame in.
void DoorReader::AddPanelWidths(const IfcInstance& type, double door_width_m, bool mirrored, std::vector<FramedLeaf>& leaves) const {
  if (leaves.size() != 2 || !(door_width_m > 0)) return;
  double left = 0, right = 0;
  for (const StepValue reference : type[attribute::kTypePropertySets].Items()) {
    if (!model_.Spend(1, type.index)) return;
    const IfcInstance panel = model_.Follow(reference);
    if (!panel || panel.type != IfcType::kIfcDoorPanelProperties) continue;
    const std::string_view position = panel[attribute::kPanelPosition].Enumeration();
    if (position == "LEFT") left = model_.Number(panel, attribute::kPanelWidth);
    if (position == "RIGHT") right = model_.Number(panel, attribute::kPanelWidth);
  }
  if (!(left > 0 && right > 0 && std::isfinite(left + right))) return;
  if (mirrored) std::swap(left, right);
  for (FramedLeaf& leaf : leaves) leaf.width_m = (leaf.at_x < 0 ? left : right) / (left + right) * door_width_m;
}

std::vector<IfcInstance> DoorReader::Items(const IfcInstance& door) const {
  std::vector<IfcInstance> out;
  const IfcInstance shape = model_.Follow(door[attribute::kRepresentation]);
  if (!shape || shape.type != IfcType::kIfcProductDefinitionShape) return out;
  for (const StepValue reference : shape[attribute::kShapeRepresentations].Items()) {
    const IfcInstance representation = model_.Follow(reference);
    if (!representation || representation.type != IfcType::kIfcShapeRepresentation) continue;
    for (const StepValue item : representation[attribute::kRepresentationItems].Items()) {
      if (!model_.Spend(1, door.index)) return {};
      if (const IfcInstance found = model_.Follow(item)) out.push_back(found);
    }
  }
  return out;
}

Affine3d DoorReader::Mapping(const IfcInstance& item, const IfcInstance& map) const {
  return placements_.Operator(item[attribute::kMappingTarget]) * Affine3d(placements_.AxisPlacement(map[attribute::kMapOrigin]).matrix());
}

Matrix3d DoorReader::FrameOfType(const IfcInstance& door, const IfcInstance& type) const {
  std::vector<uint32_t> maps;
  for (const StepValue reference : type[attribute::kTypeRepresentationMaps].Items()) {
    if (!model_.Spend(1, type.index)) return Matrix3d::Identity();
    maps.push_back(model_.Resolve(reference));
  }
  std::sort(maps.begin(), maps.end());
  for (const IfcInstance& item : Items(door)) {
    if (item.type != IfcType::kIfcMappedItem) continue;
    const IfcInstance map = model_.Follow(item[attribute::kMappingSource]);
    if (map && std::binary_search(maps.begin(), maps.end(), map.index)) return Mapping(item, map).linear();
  }
  return Matrix3d::Identity();
}

void DoorReader::AddSwings(const IfcInstance& item, const Affine3d& T_door_item, int depth, std::vector<Swing>& swings) const {
  if (!item || depth > kMaxDepth || swings.size() > kMaxSwings || !model_.Spend(1, item.index)) return;
  const auto add_all = [&](StepValue references, const Affine3d& T) {
    for (const StepValue reference : references.Items()) AddSwings(model_.Follow(reference), T, depth + 1, swings);
  };
  const auto add_arcs = [&] {
    for (const Arc& arc : curves_.Read(item).arcs) {
      if (swings.size() > kMaxSwings || !model_.Spend(1, item.index)) return;
      if (std::abs(arc.sweep_rad) < kMinSwing_rad || std::abs(arc.sweep_rad) > kMaxSwing_rad) continue;
      const auto at = [&](double angle_rad) {
        const Vector2d p = arc.center + arc.radius_m * Vector2d(std::cos(angle_rad), std::sin(angle_rad));
        return Vector3d(T_door_item * Vector3d(p.x(), p.y(), 0));
      };
      const Vector3d hinge = T_door_item * Vector3d(arc.center.x(), arc.center.y(), 0);
      swings.push_back({hinge, at(arc.start_rad), at(arc.start_rad + arc.sweep_rad)});
    }
  };
  switch (item.type) {
    case IfcType::kIfcMappedItem: {
      const IfcInstance map = model_.Follow(item[attribute::kMappingSource]);
      if (!map || map.type != IfcType::kIfcRepresentationMap) return;
      const Affine3d T_door_map = T_door_item * Mapping(item, map);
      for (const Swing& s : InMap(map, depth)) {
        if (swings.size() > kMaxSwings || !model_.Spend(1, item.index)) return;
        swings.push_back({T_door_map * s.hinge, T_door_map * s.start, T_door_map * s.end});
      }
      return;
    }
    case IfcType::kIfcGeometricSet:
    case IfcType::kIfcGeometricCurveSet: add_all(item[attribute::kSetElements], T_door_item); return;
    case IfcType::kIfcCompositeCurve: add_all(item[attribute::kCompositeSegments], T_door_item); return;
    case IfcType::kIfcCompositeCurveSegment:
      AddSwings(model_.Follow(item[attribute::kSegmentCurve]), T_door_item, depth + 1, swings);
      return;
    case IfcType::kIfcTrimmedCurve: {
      const IfcInstance basis = model_.Follow(item[attribute::kTrimBasis]);
      if (basis && basis.type == IfcType::kIfcCircle) add_arcs();
      return;
    }
    case IfcType::kIfcIndexedPolyCurve: add_arcs(); return;
    default: return;  // bodies, texts, other curves
  }
}

// Many doors share one: it is read once. Empty while it is, so that a map within itself ends there.
const std::vector<DoorReader::Swing>& DoorReader::InMap(const IfcInstance& map, int depth) const {
  if (!in_map_.try_emplace(map.index).second) return in_map_[map.index];
  std::vector<Swing> swings;
  if (const IfcInstance representation = model_.Follow(map[attribute::kMappedRepresentation])) {
    for (const StepValue item : representation[attribute::kRepresentationItems].Items())
      AddSwings(model_.Follow(item), Affine3d::Identity(), depth + 1, swings);
  }
  return in_map_[map.index] = std::move(swings);
}

std::vector<FramedLeaf> DoorReader::Drawn(const IfcInstance& door, double door_width_m) const {
  std::vector<Swing> swings;
  for (const IfcInstance& item : Items(door)) AddSwings(item, Affine3d::Identity(), 0, swings);
  std::vector<FramedLeaf> leaves;
  for (const Swing& s : swings) {
    const double rise_m = std::max(std::abs(s.start.z() - s.hinge.z()), std::abs(s.end.z() - s.hinge.z()));
    if (rise_m > kFlat * (s.start - s.hinge).norm()) continue;
    const auto leaf = LeafOfSwing(s.hinge.head<2>(), s.start.head<2>(), s.end.head<2>(), door_width_m);
    if (leaf) leaves.push_back(*leaf);
  }
  return OnePerJamb(leaves, door_width_m);
}

}  // namespace plumb::compiler
