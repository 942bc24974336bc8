// The building elements of an IFC file with their bodies, before openings are cut.
#pragma once

#include <vector>

#include "compiler/frontends/ifc/ifc_options.h"
#include "compiler/frontends/ifc/ifc_products.h"
#include "compiler/frontends/ifc/ifc_relations.h"
#include "compiler/frontends/ifc/ifc_shape.h"
#include "compiler/ir/plan_ir.h"

namespace plumb::compiler {

struct Product {
  uint32_t instance = StepFile::kNone;
  ElementKind kind = ElementKind::kOther;
  ShapeParts parts;                // plan frame
  Eigen::AlignedBox3d box;         // of the parts, for what may fill an opening; once they are taken
  uint32_t whole = kNoIndex;       // product that it is a part of, if both become one element
  uint32_t frame = kNoIndex;       // for a door or window among the parts of a curtain wall or wall: that product
  std::vector<uint32_t> fillings;  // the products of which it is the frame
  bool has_parts = false;          // others were merged into it
  bool has_body = false;           // it has parts, or had them until they were taken
};

[[nodiscard]] inline bool IsWallLike(ElementKind kind) { return kind == ElementKind::kWall || kind == ElementKind::kCurtainWall; }
[[nodiscard]] inline bool FillsOpenings(ElementKind kind) { return kind == ElementKind::kDoor || kind == ElementKind::kWindow; }

// Also where the file does not say so, by its place.
[[nodiscard]] inline bool MayFill(ElementKind kind) { return FillsOpenings(kind) || kind == ElementKind::kCurtainWall; }

class ProductTable {
 public:
  // Reads all products. The parts of a wall or curtain wall (IfcRelAggregates) are merged into it, but for doors and windows; the parts of
  // stairs and roofs take their kind. What is passed must outlive the table.
  ProductTable(const IfcModel& model, PlacementReader& placements, const StyleReader& styles, ShapeReader& shapes,
               const Relations& relations, const IfcOptions& options);

  [[nodiscard]] uint32_t size() const { return static_cast<uint32_t>(products_.size()); }
  [[nodiscard]] const Product& operator[](uint32_t product) const { return products_[product]; }
  // The parts of a product, whose solids the table then no longer has unless another product frames it; its box stays.
  [[nodiscard]] ShapeParts TakeParts(uint32_t product);
  [[nodiscard]] size_t CountFillings() const;  // doors and windows
  // The product that an instance became part of; kNoIndex if it is none.
  [[nodiscard]] uint32_t Root(uint32_t instance) const;
  // The body of any instance with placement and shape, in the plan frame. Beyond IfcOptions.max_triangles of all bodies together:
  // PlanTooComplex.
  [[nodiscard]] ShapeParts PlacedBody(uint32_t instance);

 private:
  // The product furthest up the chain of wholes that is a wall, and the kind of the first stair or roof on the way.
  struct Ancestry {
    uint32_t wall = kNoIndex;
    std::optional<ElementKind> kind;
  };
  [[nodiscard]] Ancestry AncestryOf(const Product& product) const;
  [[nodiscard]] Product Read(uint32_t instance, ElementKind kind);
  [[nodiscard]] uint32_t Find(uint32_t instance) const;  // kNoIndex: it is no product
  void RelateParts();
  void MergeParts();

  const IfcModel& model_;
  PlacementReader& placements_;
  const StyleReader& styles_;
  ShapeReader& shapes_;
  const Relations& relations_;
  const IfcOptions& options_;
  size_t triangles_ = 0;           // of all bodies
  std::vector<Product> products_;  // in the order of their instances
};

}  // namespace plumb::compiler
