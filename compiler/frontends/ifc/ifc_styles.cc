#include "compiler/frontends/ifc/ifc_styles.h"

#include <algorithm>
#include <string>

namespace plumb::compiler {
namespace {

constexpr int kMaxDepth = 8;
constexpr std::string_view kGlass[] = {"glas", "glaz", "verre", "vitr", "vidr", "vetro"};
constexpr std::string_view kNotGlass[] = {"glaswol",   "glass wool", "glasswool", "glasfaser",   "glasvlies",
                                          "glass fib", "fiberglas",  "fibreglas", "glass block", "glasbaustein"};

// Stated glass wins over stated opaque, that over nothing.
Look Stronger(Look a, Look b) { return std::max(a, b); }

}  // namespace

bool IsGlassName(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const auto contains = [&lower](std::string_view word) { return lower.find(word) != std::string::npos; };
  return std::any_of(std::begin(kGlass), std::end(kGlass), contains) && std::none_of(std::begin(kNotGlass), std::end(kNotGlass), contains);
}

StyleReader::StyleReader(const IfcModel& model, double glass_transparency) : model_(model), glass_transparency_(glass_transparency) {
  for (const uint32_t index : model.InstancesOf(IfcType::kIfcStyledItem)) {
    const IfcInstance styled = model.Get(index);
    const StepValue item = styled[attribute::kStyledItemItem];
    if (item.is_null()) continue;
    const uint32_t target = model.Resolve(item);
    Look look = Look::kUnstated;
    for (const StepValue style : styled[attribute::kStyledItemStyles].Items()) look = Stronger(look, OfStyle(model.Follow(style), 0));
    if (target != StepFile::kNone) by_item_[target] = Stronger(by_item_[target], look);
  }
  // Styles of materials: a styled item without an item, in a representation of the material.
  for (const uint32_t index : model.InstancesOf(IfcType::kIfcMaterialDefinitionRepresentation)) {
    const IfcInstance definition = model.Get(index);
    const uint32_t material = model.Resolve(definition[attribute::kRepresentedMaterial]);
    Look look = Look::kUnstated;
    for (const StepValue item : definition[attribute::kMaterialRepresentations].Items()) {
      const IfcInstance representation = model.Follow(item);
      if (!representation) continue;
      for (const StepValue styled_item : representation[attribute::kRepresentationItems].Items()) {
        const IfcInstance styled = model.Follow(styled_item);
        if (!styled || styled.type != IfcType::kIfcStyledItem) continue;
        for (const StepValue style : styled[attribute::kStyledItemStyles].Items()) look = Stronger(look, OfStyle(model.Follow(style), 0));
      }
    }
    if (material != StepFile::kNone) by_material_[material] = Stronger(by_material_[material], look);
  }
}

Look StyleReader::OfStyle(const IfcInstance& style, int depth) const {
  Look look = Look::kUnstated;
  if (!style || depth > kMaxDepth || !model_.Spend(1, style.index)) return look;
  switch (style.type) {
    case IfcType::kIfcPresentationStyleAssignment:
      for (const StepValue item : style[attribute::kStyleAssignmentStyles].Items())
        look = Stronger(look, OfStyle(model_.Follow(item), depth + 1));
      return look;
    case IfcType::kIfcSurfaceStyle:
      if (IsGlassName(style[attribute::kSurfaceStyleName].Text())) return Look::kGlass;
      for (const StepValue item : style[attribute::kSurfaceStyleStyles].Items())
        look = Stronger(look, OfStyle(model_.Follow(item), depth + 1));
      return look;
    case IfcType::kIfcSurfaceStyleRendering:
    case IfcType::kIfcSurfaceStyleShading: {
      const auto transparency = style[attribute::kShadingTransparency].Real();
      return transparency && *transparency > glass_transparency_ ? Look::kGlass : Look::kOpaque;
    }
    default: return look;
  }
}

Look StyleReader::OfItem(uint32_t item) const {
  const auto found = by_item_.find(item);
  return found == by_item_.end() ? Look::kUnstated : found->second;
}

Look StyleReader::OfMaterial(const IfcInstance& material, int depth) const {
  if (!material || depth > kMaxDepth || !model_.Spend(1, material.index)) return Look::kUnstated;
  const auto all_of = [&](StepItems items) {
    Look look = Look::kUnstated;
    for (const StepValue item : items) {
      const Look part = OfMaterial(model_.Follow(item), depth + 1);
      if (part != Look::kGlass) return Look::kUnstated;
      look = part;
    }
    return look;
  };
  switch (material.type) {
    case IfcType::kIfcMaterial: {
      if (IsGlassName(material[attribute::kMaterialName].Text())) return Look::kGlass;
      const auto found = by_material_.find(material.index);
      return found == by_material_.end() ? Look::kUnstated : found->second;
    }
    case IfcType::kIfcMaterialLayer:
    case IfcType::kIfcMaterialLayerWithOffsets: return OfMaterial(model_.Follow(material[attribute::kLayerMaterial]), depth + 1);
    case IfcType::kIfcMaterialLayerSetUsage: return OfMaterial(model_.Follow(material[attribute::kLayerUsageSet]), depth + 1);
    case IfcType::kIfcMaterialLayerSet: return all_of(material[attribute::kLayerSetLayers].Items());
    case IfcType::kIfcMaterialList: return all_of(material[attribute::kMaterialListMaterials].Items());
    case IfcType::kIfcMaterialConstituentSet: return all_of(material[attribute::kConstituentSetConstituents].Items());
    case IfcType::kIfcMaterialConstituent: return OfMaterial(model_.Follow(material[attribute::kConstituentMaterial]), depth + 1);
    default: return Look::kUnstated;
  }
}

}  // namespace plumb::compiler
