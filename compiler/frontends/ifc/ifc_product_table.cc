#include "compiler/frontends/ifc/ifc_product_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "compiler/frontends/ifc/ifc_panes.h"

namespace plumb::compiler {

ProductTable::ProductTable(const IfcModel& model, PlacementReader& placements, const StyleReader& styles, ShapeReader& shapes,
                           const Relations& relations, const IfcOptions& options)
    : model_(model), placements_(placements), styles_(styles), shapes_(shapes), relations_(relations), options_(options) {
  const ProductKinds kinds(model);
  const std::vector<uint32_t> instances = kinds.Products();
  products_.reserve(instances.size());
  for (const uint32_t instance : instances) {
    if (model.is_too_complex()) break;
    products_.push_back(Read(instance, *kinds.Of(instance)));
  }
  RelateParts();
  MergeParts();
  for (Product& product : products_) product.has_body = !product.parts.empty();
}

size_t ProductTable::CountFillings() const {
  return static_cast<size_t>(std::count_if(products_.begin(), products_.end(), [](const Product& p) { return FillsOpenings(p.kind); }));
}

uint32_t ProductTable::Find(uint32_t instance) const {
  const auto at =
      std::lower_bound(products_.begin(), products_.end(), instance, [](const Product& p, uint32_t i) { return p.instance < i; });
  return at != products_.end() && at->instance == instance ? static_cast<uint32_t>(at - products_.begin()) : kNoIndex;
}

ShapeParts ProductTable::TakeParts(uint32_t product) {
  Product& from = products_[product];
  if (MayFill(from.kind)) {
    for (const ShapePart& part : from.parts) from.box.extend(Bounds(part.solid));
  }
  if (from.frame != kNoIndex) return from.parts;
  return std::move(from.parts);
}

ShapeParts ProductTable::PlacedBody(uint32_t instance) {
  const IfcInstance product = model_.Get(instance);
  const StepValue shape = product[attribute::kRepresentation];
  if (shape.is_null()) return {};
  ShapeParts parts = shapes_.Body(model_.Follow(shape));
  const Eigen::Affine3d T_plan_product(placements_.ObjectPlacement(product[attribute::kPlacement]).matrix());
  for (ShapePart& part : parts) {
    TransformPart(T_plan_product, part);
    triangles_ += part.solid.triangles.size();
  }
  KeepInRange(model_, instance, parts);
  if (triangles_ > options_.max_triangles && !model_.is_too_complex()) {
    model_.Emit(DiagnosticKind::kPlanTooComplex, instance,
                fmt::format("the bodies up to {} have over {} triangles; at most that many are read", model_.Label(instance),
                            options_.max_triangles));
  }
  return parts;
}

Product ProductTable::Read(uint32_t instance, ElementKind kind) {
  Product product;
  product.instance = instance;
  product.kind = kind;
  if (kind == ElementKind::kSlab && model_.Get(instance)[attribute::kSlabType].Enumeration() == "ROOF") product.kind = ElementKind::kRoof;
  product.parts = PlacedBody(instance);
  const uint32_t material = relations_.MaterialOf(instance);
  const Look look = material == StepFile::kNone ? Look::kUnstated : styles_.OfMaterial(model_.Get(material));
  for (ShapePart& part : product.parts) {
    // A door or window of a material "glass" still has a frame: there only a style on the part itself tells.
    if (part.look == Look::kUnstated && !FillsOpenings(kind)) part.look = look;
  }
  if (kind == ElementKind::kWindow) MarkPanes(options_, product.parts);
  for (ShapePart& part : product.parts) ShrinkSolid(part.solid);
  return product;
}

ProductTable::Ancestry ProductTable::AncestryOf(const Product& product) const {
  constexpr int kMaxSteps = 32;
  Ancestry out;
  uint32_t at = relations_.WholeOf(product.instance);
  for (int step = 0; step < kMaxSteps && at != StepFile::kNone; ++step, at = relations_.WholeOf(at)) {
    const uint32_t p = Find(at);
    if (p == kNoIndex || &products_[p] == &product) continue;
    const ElementKind kind = products_[p].kind;
    if (IsWallLike(kind)) out.wall = p;
    if (!out.kind && (kind == ElementKind::kStair || kind == ElementKind::kRoof)) out.kind = kind;
  }
  return out;
}

void ProductTable::RelateParts() {
  std::vector<Ancestry> ancestries;
  for (const Product& product : products_) ancestries.push_back(AncestryOf(product));
  for (uint32_t p = 0; p < size(); ++p) {
    Product& product = products_[p];
    const Ancestry& ancestry = ancestries[p];
    const bool is_plain = product.kind == ElementKind::kSlab || product.kind == ElementKind::kBeam || product.kind == ElementKind::kOther;
    if (ancestry.kind && is_plain) product.kind = *ancestry.kind;
    // A chain that leads round in a circle has no topmost wall.
    if (ancestry.wall == kNoIndex || ancestries[ancestry.wall].wall != kNoIndex) continue;
    if (FillsOpenings(product.kind)) {
      product.frame = ancestry.wall;
      products_[ancestry.wall].fillings.push_back(p);
    } else {
      product.whole = ancestry.wall;
    }
  }
}

void ProductTable::MergeParts() {
  for (Product& product : products_) {
    if (product.whole == kNoIndex || product.parts.empty()) continue;
    Product& whole = products_[product.whole];
    // A wall with a body of its own says by its parts only what it is made of; a curtain wall's own body is the simplification.
    if (!whole.has_parts && !whole.parts.empty() && whole.kind == ElementKind::kWall) continue;
    if (!whole.has_parts) whole.parts.clear();
    whole.has_parts = true;
    whole.parts.insert(whole.parts.end(), std::make_move_iterator(product.parts.begin()), std::make_move_iterator(product.parts.end()));
    product.parts.clear();
  }
}

uint32_t ProductTable::Root(uint32_t instance) const {
  const uint32_t p = Find(instance);
  if (p == kNoIndex) return kNoIndex;
  return products_[p].whole == kNoIndex ? p : products_[p].whole;
}

}  // namespace plumb::compiler
