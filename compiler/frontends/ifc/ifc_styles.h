// What IFC says about how things look, as far as it tells glass from the rest.
#pragma once

#include <string_view>
#include <unordered_map>

#include "compiler/frontends/ifc/ifc_model.h"

namespace plumb::compiler {

enum class Look { kUnstated, kOpaque, kGlass };

// Names of styles and materials: "Glass", "Verglasung", "vitrage"; not "glass wool" or "Glasfaser".
[[nodiscard]] bool IsGlassName(std::string_view name);

class StyleReader {
 public:
  StyleReader(const IfcModel& model, double glass_transparency);

  // Of a representation item, by the IfcStyledItem on it.
  [[nodiscard]] Look OfItem(uint32_t item) const;
  // Of an IfcMaterial or what is made of materials: glass if all that it names is glass, by its name or by its style.
  [[nodiscard]] Look OfMaterial(const IfcInstance& material, int depth = 0) const;

 private:
  [[nodiscard]] Look OfStyle(const IfcInstance& style, int depth) const;

  const IfcModel& model_;
  double glass_transparency_;
  std::unordered_map<uint32_t, Look> by_item_, by_material_;
};

}  // namespace plumb::compiler
