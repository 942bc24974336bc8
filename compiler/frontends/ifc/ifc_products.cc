#include "compiler/frontends/ifc/ifc_products.h"

#include <algorithm>

namespace plumb::compiler {
namespace {

struct KnownKind {
  IfcType type;
  ElementKind kind;
};
constexpr KnownKind kKnown[] = {
    {IfcType::kIfcWall, ElementKind::kWall},
    {IfcType::kIfcWallStandardCase, ElementKind::kWall},
    {IfcType::kIfcWallElementedCase, ElementKind::kWall},
    {IfcType::kIfcCurtainWall, ElementKind::kCurtainWall},
    {IfcType::kIfcSlab, ElementKind::kSlab},
    {IfcType::kIfcSlabStandardCase, ElementKind::kSlab},
    {IfcType::kIfcSlabElementedCase, ElementKind::kSlab},
    {IfcType::kIfcFooting, ElementKind::kSlab},
    {IfcType::kIfcRoof, ElementKind::kRoof},
    {IfcType::kIfcColumn, ElementKind::kColumn},
    {IfcType::kIfcColumnStandardCase, ElementKind::kColumn},
    {IfcType::kIfcPile, ElementKind::kColumn},
    {IfcType::kIfcBeam, ElementKind::kBeam},
    {IfcType::kIfcBeamStandardCase, ElementKind::kBeam},
    {IfcType::kIfcMember, ElementKind::kBeam},
    {IfcType::kIfcMemberStandardCase, ElementKind::kBeam},
    {IfcType::kIfcPlate, ElementKind::kOther},
    {IfcType::kIfcPlateStandardCase, ElementKind::kOther},
    {IfcType::kIfcStair, ElementKind::kStair},
    {IfcType::kIfcStairFlight, ElementKind::kStair},
    {IfcType::kIfcRamp, ElementKind::kStair},
    {IfcType::kIfcRampFlight, ElementKind::kStair},
    {IfcType::kIfcRailing, ElementKind::kRailing},
    {IfcType::kIfcDoor, ElementKind::kDoor},
    {IfcType::kIfcDoorStandardCase, ElementKind::kDoor},
    {IfcType::kIfcWindow, ElementKind::kWindow},
    {IfcType::kIfcWindowStandardCase, ElementKind::kWindow},
    {IfcType::kIfcFurnishingElement, ElementKind::kFurniture},
    {IfcType::kIfcFurniture, ElementKind::kFurniture},
    {IfcType::kIfcSystemFurnitureElement, ElementKind::kFurniture},
    {IfcType::kIfcCovering, ElementKind::kCovering},
    {IfcType::kIfcBuildingElementProxy, ElementKind::kProxy},
    {IfcType::kIfcProxy, ElementKind::kProxy},
    {IfcType::kIfcBuildingElementPart, ElementKind::kOther},
    {IfcType::kIfcSite, ElementKind::kGround},
    {IfcType::kIfcGeographicElement, ElementKind::kGround},
};

constexpr size_t kGuidLength = 22;

bool LooksLikeProduct(const IfcModel& model, const IfcInstance& instance) {
  if (instance[attribute::kGlobalId].Text().size() != kGuidLength) return false;
  const StepValue shape = instance[attribute::kRepresentation];
  if (shape.kind() != StepValue::Kind::kReference) return false;
  const IfcInstance definition = model.Follow(shape);
  return definition && definition.type == IfcType::kIfcProductDefinitionShape;
}

}  // namespace

ProductKinds::ProductKinds(const IfcModel& model) : model_(model), kinds_(model.file().type_count()) {
  for (const KnownKind& known : kKnown) {
    const auto instances = model.InstancesOf(known.type);
    if (!instances.empty()) kinds_[model.file().type(instances[0])] = known.kind;
  }
  for (uint16_t type = 0; type < kinds_.size(); ++type) {
    const auto instances = model.file().InstancesOf(type);
    if (instances.empty() || model.TypeOf(instances[0]) != IfcType::kUnknown || model.file().type_name(type).starts_with("IFCSTRUCTURAL"))
      continue;
    const bool is_product =
        std::any_of(instances.begin(), instances.end(), [&](uint32_t i) { return LooksLikeProduct(model, model.Get(i)); });
    if (is_product) kinds_[type] = ElementKind::kOther;
  }
}

std::vector<uint32_t> ProductKinds::Products() const {
  std::vector<uint32_t> products;
  for (uint32_t i = 0; i < model_.size(); ++i) {
    if (Of(i)) products.push_back(i);
  }
  return products;
}

}  // namespace plumb::compiler
