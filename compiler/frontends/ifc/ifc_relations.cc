#include "compiler/frontends/ifc/ifc_relations.h"

#include <fmt/format.h>

namespace plumb::compiler {
namespace {

constexpr int kMaxSteps = 64;  // up a chain of wholes

}  // namespace

Relations::Relations(const IfcModel& model) : model_(model) {
  ReadOneToMany(IfcType::kIfcRelNests, attribute::kAggregateWhole, attribute::kAggregateParts, whole_);
  ReadOneToMany(IfcType::kIfcRelAggregates, attribute::kAggregateWhole, attribute::kAggregateParts, whole_);
  ReadOneToMany(IfcType::kIfcRelContainedInSpatialStructure, attribute::kContainingStructure, attribute::kContainedElements, structure_);
  ReadOneToMany(IfcType::kIfcRelAssociatesMaterial, attribute::kRelatingDefinition, attribute::kRelatedObjects, material_);
  ReadOneToMany(IfcType::kIfcRelDefinesByType, attribute::kRelatingDefinition, attribute::kRelatedObjects, type_);
  ReadOneToMany(IfcType::kIfcRelVoidsElement, attribute::kVoidedElement, attribute::kVoidingOpening, host_);
  ReadOneToMany(IfcType::kIfcRelFillsElement, attribute::kFilledOpening, attribute::kFillingElement, opening_);
  ReadExternal();
}

// `many` is a list of references or a single one.
void Relations::ReadOneToMany(IfcType relation, size_t one, size_t many, InstanceMap& one_of_many) const {
  for (const uint32_t index : model_.InstancesOf(relation)) {
    const IfcInstance rel = model_.Get(index);
    const uint32_t relating = model_.Resolve(rel[one]);
    if (relating == StepFile::kNone) continue;
    const auto set = [&](StepValue reference) {
      const uint32_t related = model_.Resolve(reference);
      if (related != StepFile::kNone && related != relating) one_of_many.Set(related, relating);
    };
    if (rel[many].kind() == StepValue::Kind::kReference) {
      set(rel[many]);
    } else {
      for (const StepValue item : rel[many].Items()) set(item);
    }
  }
}

void Relations::ReadExternal() {
  for (const uint32_t index : model_.InstancesOf(IfcType::kIfcRelDefinesByProperties)) {
    const IfcInstance rel = model_.Get(index);
    const IfcInstance set = model_.Follow(rel[attribute::kRelatingDefinition]);
    if (!set || set.type != IfcType::kIfcPropertySet) continue;
    const std::string name = set[attribute::kPropertySetName].Text();
    if (!name.starts_with("Pset_") || !name.ends_with("Common")) continue;
    for (const StepValue item : set[attribute::kPropertySetProperties].Items()) {
      const IfcInstance property = model_.Follow(item);
      if (!property || property.type != IfcType::kIfcPropertySingleValue || property[attribute::kPropertyName].Text() != "IsExternal")
        continue;
      const std::optional<bool> value = property[attribute::kPropertyValue].Boolean();
      if (!value) continue;
      for (const StepValue object : rel[attribute::kRelatedObjects].Items()) {
        const uint32_t target = model_.Resolve(object);
        if (target != StepFile::kNone) external_[target] = *value;
      }
    }
  }
}

uint32_t Relations::MaterialOf(uint32_t object) const {
  if (material_[object] != StepFile::kNone) return material_[object];
  const uint32_t type = type_[object];
  return type == StepFile::kNone ? StepFile::kNone : material_[type];
}

std::optional<bool> Relations::IsExternal(uint32_t element) const {
  const auto stated = external_.find(element);
  return stated == external_.end() ? std::nullopt : std::optional(stated->second);
}

uint32_t Relations::StoreyOf(uint32_t object) const {
  uint32_t at = object;
  for (int step = 0; step < kMaxSteps && at != StepFile::kNone; ++step) {
    if (model_.TypeOf(at) == IfcType::kIfcBuildingStorey) return at;
    if (structure_[at] != StepFile::kNone) {
      at = structure_[at];
    } else if (whole_[at] != StepFile::kNone) {
      at = whole_[at];
    } else if (opening_[at] != StepFile::kNone) {
      at = opening_[at];
    } else {
      at = host_[at];
    }
  }
  return StepFile::kNone;
}

std::optional<double> Relations::LayerThickness_m(uint32_t object) const {
  const uint32_t material = MaterialOf(object);
  if (material == StepFile::kNone) return std::nullopt;
  IfcInstance set = model_.Get(material);
  if (set.type == IfcType::kIfcMaterialLayerSetUsage) set = model_.Follow(set[attribute::kLayerUsageSet]);
  if (!set || set.type != IfcType::kIfcMaterialLayerSet) return std::nullopt;
  double thickness_m = 0;
  for (const StepValue item : set[attribute::kLayerSetLayers].Items()) {
    if (const IfcInstance layer = model_.Follow(item)) thickness_m += model_.Length(layer, attribute::kLayerThickness);
  }
  return thickness_m > 0 ? std::optional(thickness_m) : std::nullopt;
}

}  // namespace plumb::compiler
