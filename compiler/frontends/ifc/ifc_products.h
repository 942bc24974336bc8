// Which instances of an IFC file are building elements, and of what kind.
#pragma once

#include <optional>
#include <vector>

#include "compiler/frontends/ifc/ifc_model.h"
#include "schema/agraph.h"

namespace plumb::compiler {

// The kind of a product that becomes an element of the plan. None for openings, spaces, annotations, structure and what is no product.
// Types that the frontend does not know are products (kOther) if their instances are built like one: a GlobalId first, placement and shape
// at their places.
class ProductKinds {
 public:
  explicit ProductKinds(const IfcModel& model);
  [[nodiscard]] std::optional<ElementKind> Of(uint32_t index) const { return kinds_[model_.file().type(index)]; }
  // All that have one, in the order of the file.
  [[nodiscard]] std::vector<uint32_t> Products() const;

 private:
  const IfcModel& model_;
  std::vector<std::optional<ElementKind>> kinds_;  // by the file's type number
};

}  // namespace plumb::compiler
