#include "compiler/frontends/ifc/ifc_frontend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/frontends/ifc/ifc_model.h"
#include "compiler/frontends/ifc/ifc_openings.h"
#include "compiler/frontends/ifc/ifc_panes.h"
#include "compiler/frontends/ifc/ifc_placement.h"
#include "compiler/frontends/ifc/ifc_products.h"
#include "compiler/frontends/ifc/ifc_relations.h"
#include "compiler/frontends/ifc/ifc_shape.h"
#include "compiler/frontends/ifc/ifc_units.h"

namespace plumb::compiler {
namespace {

using Eigen::Affine3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr uint32_t kNone = StepFile::kNone;

struct Product {
  uint32_t instance = kNone;
  ElementKind kind = ElementKind::kOther;
  ShapeParts parts;           // plan frame
  uint32_t whole = kNoIndex;  // product that it is a part of, if both become one element
  uint32_t frame = kNoIndex;  // for a door or window among the parts of a curtain wall or wall: that product
  bool has_parts = false;     // others were merged into it
};

bool IsWallLike(ElementKind kind) { return kind == ElementKind::kWall || kind == ElementKind::kCurtainWall; }
bool HasUncut(ElementKind kind) { return IsWallLike(kind) || kind == ElementKind::kColumn; }
bool FillsOpenings(ElementKind kind) { return kind == ElementKind::kDoor || kind == ElementKind::kWindow; }

// Arcs of an extruded profile in the plan frame, if it stands upright; exact only then.
void AppendArcs(const ShapePart& part, std::vector<Arc>& out) {
  const Eigen::Matrix3d m = part.T_part_profile.linear();
  const double scale = m.col(0).norm();
  const bool upright = std::abs(m.col(0).z()) < 1e-6 * scale && std::abs(m.col(1).z()) < 1e-6 * scale;
  const bool similar = std::abs(m.col(1).norm() - scale) < 1e-6 * scale && std::abs(m.col(0).dot(m.col(1))) < 1e-6 * scale * scale;
  if (!upright || !similar) return;
  const double sign = m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0) > 0 ? 1 : -1;
  for (const Arc& arc : part.arcs) {
    const Vector3d center = part.T_part_profile * Vector3d(arc.center.x(), arc.center.y(), 0);
    const Vector3d spoke = m * Vector3d(std::cos(arc.start_rad), std::sin(arc.start_rad), 0);
    out.push_back({center.head<2>(), arc.radius_m * scale, std::atan2(spoke.y(), spoke.x()), sign * arc.sweep_rad});
  }
}

class Frontend {
 public:
  Frontend(const IfcModel& model, const IfcOptions& options)
      : model_(model),
        options_(options),
        placements_(model),
        styles_(model, options.glass_transparency),
        shapes_(model, placements_, styles_, options),
        relations_(model),
        kinds_(model) {}

  PlanIr Run() {
    ReadStoreys();
    ReadProducts();
    MergeParts();
    ReadOpenings();
    MakeElements();
    MakeOpenings();
    ReadSpaces();
    MoveNearZero();
    if (plan_.storeys.empty()) MakeStorey();
    return std::move(plan_);
  }

 private:
  struct Opening {
    uint32_t instance = kNone;
    uint32_t product = kNoIndex;  // that it voids
    std::vector<Solid> solids;
    bool cuts = false, cut_before = false;
  };

  std::string TextOf(uint32_t instance, size_t attribute_index) const { return model_.Get(instance)[attribute_index].Text(); }

  ShapeParts PlacedBody(uint32_t instance) {
    const IfcInstance product = model_.Get(instance);
    const StepValue shape = product[attribute::kRepresentation];
    if (shape.is_null()) return {};
    ShapeParts parts = shapes_.Body(model_.Follow(shape));
    const Affine3d T_plan_product(placements_.ObjectPlacement(product[attribute::kPlacement]).matrix());
    for (ShapePart& part : parts) TransformPart(T_plan_product, part);
    return parts;
  }

  void ReadStoreys() {
    struct Entry {
      uint32_t instance;
      PlanStorey storey;
    };
    std::vector<Entry> entries;
    for (const uint32_t instance : model_.InstancesOf(IfcType::kIfcBuildingStorey)) {
      const IfcInstance storey = model_.Get(instance);
      PlanStorey out;
      out.location = model_.Location(instance);
      out.guid = out.location.guid;
      out.name = TextOf(instance, attribute::kName);
      if (out.name.empty()) out.name = TextOf(instance, attribute::kSpatialLongName);
      if (storey[attribute::kPlacement].is_null()) {
        out.elevation_m = model_.Length(storey, attribute::kStoreyElevation);
      } else {
        out.elevation_m = placements_.ObjectPlacement(storey[attribute::kPlacement]).translation().z();
      }
      entries.push_back({instance, std::move(out)});
    }
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.storey.elevation_m < b.storey.elevation_m; });
    storey_of_.assign(model_.size(), kNoIndex);
    for (Entry& entry : entries) {
      storey_of_[entry.instance] = static_cast<uint32_t>(plan_.storeys.size());
      plan_.storeys.push_back(std::move(entry.storey));
    }
  }

  uint32_t StoreyOf(uint32_t instance) const {
    const uint32_t storey = relations_.StoreyOf(instance);
    return storey == kNone ? kNoIndex : storey_of_[storey];
  }

  void ReadProducts() {
    product_of_.assign(model_.size(), kNoIndex);
    for (const uint32_t instance : kinds_.Products()) {
      Product product;
      product.instance = instance;
      product.kind = *kinds_.Of(instance);
      if (product.kind == ElementKind::kSlab && model_.Get(instance)[attribute::kSlabType].Enumeration() == "ROOF") product.kind = ElementKind::kRoof;
      product.parts = PlacedBody(instance);
      const uint32_t material = relations_.MaterialOf(instance);
      const Look look = material == kNone ? Look::kUnstated : styles_.OfMaterial(model_.Get(material));
      for (ShapePart& part : product.parts) {
        // A door or window of a material "glass" still has a frame: there only a style on the part itself tells.
        if (part.look == Look::kUnstated && !FillsOpenings(product.kind)) part.look = look;
      }
      if (product.kind == ElementKind::kWindow) MarkPanes(options_, product.parts);
      product_of_[instance] = static_cast<uint32_t>(products_.size());
      products_.push_back(std::move(product));
    }
  }

  // The product furthest up the chain of wholes that is a wall, and the kind of the first stair or roof on the way.
  struct Ancestry {
    uint32_t wall = kNoIndex;
    std::optional<ElementKind> kind;
  };
  Ancestry AncestryOf(const Product& product) const {
    constexpr int kMaxSteps = 32;
    Ancestry out;
    uint32_t at = relations_.WholeOf(product.instance);
    for (int step = 0; step < kMaxSteps && at != kNone; ++step, at = relations_.WholeOf(at)) {
      const uint32_t p = product_of_[at];
      if (p == kNoIndex || &products_[p] == &product) continue;
      const ElementKind kind = products_[p].kind;
      if (IsWallLike(kind)) out.wall = p;
      if (!out.kind && (kind == ElementKind::kStair || kind == ElementKind::kRoof)) out.kind = kind;
    }
    return out;
  }

  void MergeParts() {
    for (Product& product : products_) {
      const Ancestry ancestry = AncestryOf(product);
      const bool is_plain = product.kind == ElementKind::kSlab || product.kind == ElementKind::kBeam || product.kind == ElementKind::kOther;
      if (ancestry.kind && is_plain) product.kind = *ancestry.kind;
      if (ancestry.wall == kNoIndex) continue;
      if (FillsOpenings(product.kind)) {
        product.frame = ancestry.wall;
      } else {
        product.whole = ancestry.wall;
      }
    }
    for (Product& product : products_) {
      if (product.whole == kNoIndex || product.parts.empty()) continue;
      Product& whole = products_[product.whole];
      // A wall with a body of its own says by its parts only what it is made of; a curtain wall's own body is the simplification.
      if (!whole.has_parts && !whole.parts.empty() && whole.kind == ElementKind::kWall) continue;
      if (!whole.has_parts) whole.parts.clear();
      whole.has_parts = true;
      whole.parts.insert(whole.parts.end(), std::make_move_iterator(product.parts.begin()), std::make_move_iterator(product.parts.end()));
    }
  }

  uint32_t RootProduct(uint32_t instance) const {
    const uint32_t p = instance == kNone ? kNoIndex : product_of_[instance];
    if (p == kNoIndex) return kNoIndex;
    return products_[p].whole == kNoIndex ? p : products_[p].whole;
  }

  void ReadOpenings() {
    std::vector<uint32_t> instances;
    for (const IfcType type : {IfcType::kIfcOpeningElement, IfcType::kIfcOpeningStandardCase, IfcType::kIfcVoidingFeature}) {
      const auto of_type = model_.InstancesOf(type);
      instances.insert(instances.end(), of_type.begin(), of_type.end());
    }
    std::sort(instances.begin(), instances.end());
    for (const uint32_t instance : instances) {
      if (relations_.HostOf(instance) == kNone) continue;  // cuts nothing
      Opening opening;
      opening.instance = instance;
      opening.product = RootProduct(relations_.HostOf(instance));
      for (ShapePart& part : PlacedBody(instance)) opening.solids.push_back(std::move(part.solid));
      if (opening.solids.empty()) {
        model_.Emit(DiagnosticKind::kOpeningWithoutBody, instance, fmt::format("the opening {} has no body that can be read; it cuts nothing", model_.Label(instance)));
      }
      openings_.push_back(std::move(opening));
    }
  }

  // The openings that cut a product: its own, and for parts that stay elements of their own those of the wholes above them.
  std::vector<Opening*> OpeningsOf(uint32_t product) {
    std::vector<Opening*> out;
    std::vector<uint32_t> hosts = {product};
    uint32_t at = relations_.WholeOf(products_[product].instance);
    for (int step = 0; step < 8 && at != kNone; ++step, at = relations_.WholeOf(at)) {
      const uint32_t p = RootProduct(at);
      if (p != kNoIndex && products_[p].parts.empty()) hosts.push_back(p);
    }
    for (Opening& opening : openings_) {
      if (std::find(hosts.begin(), hosts.end(), opening.product) != hosts.end()) out.push_back(&opening);
    }
    return out;
  }

  void Cut(uint32_t product_index, ShapeParts& parts) {
    const Product& product = products_[product_index];
    for (Opening* opening : OpeningsOf(product_index)) {
      for (const Solid& tool : opening->solids) {
        for (ShapePart& part : parts) opening->cuts |= CutOpening(model_, {product.instance, opening->instance}, options_, tool, part.solid);
      }
    }
    std::erase_if(parts, [](const ShapePart& part) { return part.solid.empty(); });
  }

  PlanElement BaseElement(const Product& product) const {
    PlanElement element;
    element.kind = product.kind;
    element.location = model_.Location(product.instance);
    element.guid = element.location.guid;
    element.type = element.location.type;
    element.name = TextOf(product.instance, attribute::kName);
    element.storey = StoreyOf(product.instance);
    element.external = relations_.IsExternal(product.instance).value_or(false);
    return element;
  }

  void DescribeWall(const Product& product, PlanElement& element) {
    element.thickness_m = relations_.LayerThickness_m(product.instance);
    for (const ShapePart& part : product.parts) AppendArcs(part, element.arcs);
    const IfcInstance instance = model_.Get(product.instance);
    const auto axis = shapes_.Axis(model_.Follow(instance[attribute::kRepresentation]));
    if (!axis) return;
    const Eigen::Isometry3d T_plan_product = placements_.ObjectPlacement(instance[attribute::kPlacement]);
    element.axis = std::make_pair(Vector2d((T_plan_product * axis->first).head<2>()), Vector2d((T_plan_product * axis->second).head<2>()));
  }

  void CheckWall(const Product& product) const {
    for (const ShapePart& part : product.parts) {
      if (IsClosed(part.solid)) continue;
      model_.Emit(DiagnosticKind::kBodyNotClosed, product.instance,
                  fmt::format("the body of {} is not closed: its edges do not pair; openings cut its surface only", model_.Label(product.instance)));
      return;
    }
  }

  void MakeElements() {
    element_of_.assign(products_.size(), kNoIndex);
    for (uint32_t p = 0; p < products_.size(); ++p) {
      const Product& product = products_[p];
      if (product.whole != kNoIndex) continue;
      if (product.parts.empty() && !FillsOpenings(product.kind)) {
        ReportNoBody(product);
        continue;
      }
      PlanElement element = BaseElement(product);
      if (IsWallLike(product.kind)) {
        DescribeWall(product, element);
        CheckWall(product);
        if (element.storey == kNoIndex) {
          model_.Emit(DiagnosticKind::kElementWithoutStorey, product.instance, fmt::format("{} is contained in no storey", model_.Label(product.instance)));
        }
      }
      if (HasUncut(product.kind)) {
        for (const ShapePart& part : product.parts) AppendSolid(part.solid, element.uncut);
        for (const Product& other : products_) {
          if (other.frame != p) continue;
          for (const ShapePart& part : other.parts) AppendSolid(part.solid, element.uncut);
        }
      }
      ShapeParts parts = product.parts;
      Cut(p, parts);
      if (IsWallLike(product.kind) && element.arcs.empty()) RestoreUncut(p, element.uncut);
      AddElements(p, std::move(element), parts);
    }
  }

  // Some programs write bodies that are cut already: there `uncut` gets back what its openings took.
  void RestoreUncut(uint32_t product, Solid& uncut) {
    const Solid before = uncut;
    const uint32_t instance = products_[product].instance;
    for (Opening& opening : openings_) {
      if (opening.product != product || opening.cuts) continue;
      for (const Solid& solid : opening.solids) {
        const Solid piece = PieceCutBefore(solid, placements_.ObjectPlacement(model_.Get(instance)[attribute::kPlacement]), before, options_);
        opening.cut_before |= !piece.empty();
        AppendSolid(piece, uncut);
      }
    }
  }

  void ReportNoBody(const Product& product) const {
    if (product.kind == ElementKind::kWall) {
      model_.Emit(DiagnosticKind::kWallWithoutBody, product.instance, fmt::format("{} has no body that can be read; it is left out", model_.Label(product.instance)));
    }
  }

  void AddElements(uint32_t product_index, PlanElement element, const ShapeParts& parts) {
    Solid glass;
    for (const ShapePart& part : parts) AppendSolid(part.solid, part.look == Look::kGlass ? glass : element.body);
    element_of_[product_index] = static_cast<uint32_t>(plan_.elements.size());
    if (element.body.empty() && !glass.empty()) {
      element.material = Material::kGlass;
      element.body = std::move(glass);
      plan_.elements.push_back(std::move(element));
      return;
    }
    plan_.elements.push_back(element);
    if (glass.empty()) return;
    // So that one wall stays one element, the panes in it are windows.
    if (IsWallLike(element.kind)) element.kind = ElementKind::kWindow;
    element.material = Material::kGlass;
    element.body = std::move(glass);
    element.uncut = {};
    element.axis.reset();
    element.arcs.clear();
    plan_.elements.push_back(std::move(element));
  }

  uint32_t ElementOf(uint32_t instance) const {
    const uint32_t p = RootProduct(instance);
    return p == kNoIndex ? kNoIndex : element_of_[p];
  }

  void DescribeFilling(uint32_t product, PlanOpening& opening) const {
    const IfcInstance filling = model_.Get(products_[product].instance);
    opening.filling = element_of_[product];
    if (const double width_m = model_.Length(filling, attribute::kOverallWidth); width_m > 0) opening.width_m = width_m;
    if (const double height_m = model_.Length(filling, attribute::kOverallHeight); height_m > 0) opening.height_m = height_m;
  }

  void MakeOpenings() {
    std::vector<uint32_t> filling_of(model_.size(), kNoIndex);  // product, by opening instance
    std::vector<FillCandidate> unfilled, loose;
    for (uint32_t p = 0; p < products_.size(); ++p) {
      if (!FillsOpenings(products_[p].kind)) continue;
      const uint32_t opening = relations_.OpeningOf(products_[p].instance);
      if (opening != kNone) {
        filling_of[opening] = p;
      } else if (products_[p].frame == kNoIndex) {
        loose.push_back({p, BoundsOfParts(products_[p].parts)});
      }
    }
    for (const Opening& opening : openings_) {
      if (filling_of[opening.instance] != kNoIndex || opening.solids.empty()) continue;
      Eigen::AlignedBox3d box;
      for (const Solid& solid : opening.solids) box.extend(Bounds(solid));
      unfilled.push_back({opening.instance, box});
    }
    for (const auto& [product, opening] : MatchFillings(loose, unfilled, options_.fill_min_overlap)) {
      filling_of[opening] = product;
      model_.Emit(DiagnosticKind::kFillingInferred, products_[product].instance,
                  fmt::format("{} fills no opening by IfcRelFillsElement; it stands in {}, which is taken for it", model_.Label(products_[product].instance),
                              model_.Label(opening)));
    }
    for (const Opening& opening : openings_) AddOpening(opening, filling_of[opening.instance]);
    std::vector<char> is_filling(products_.size(), 0);
    for (const Opening& opening : openings_) {
      if (filling_of[opening.instance] != kNoIndex) is_filling[filling_of[opening.instance]] = 1;
    }
    for (uint32_t p = 0; p < products_.size(); ++p) {
      if (FillsOpenings(products_[p].kind) && is_filling[p] == 0) AddFillingWithoutOpening(p);
    }
  }

  static Eigen::AlignedBox3d BoundsOfParts(const ShapeParts& parts) {
    Eigen::AlignedBox3d box;
    for (const ShapePart& part : parts) box.extend(Bounds(part.solid));
    return box;
  }

  void AddOpening(const Opening& opening, uint32_t filling) {
    PlanOpening out;
    out.location = model_.Location(opening.instance);
    out.guid = out.location.guid;
    out.name = TextOf(opening.instance, attribute::kName);
    out.wall = opening.product == kNoIndex ? kNoIndex : element_of_[opening.product];
    for (const Solid& solid : opening.solids) AppendSolid(solid, out.body);
    if (filling != kNoIndex) DescribeFilling(filling, out);
    if (!opening.cuts && !opening.cut_before && !opening.solids.empty() && out.wall != kNoIndex) {
      model_.Emit(DiagnosticKind::kOpeningMissesHost, opening.instance,
                  fmt::format("the opening {} does not meet {}, which it should cut", model_.Label(opening.instance), model_.Label(relations_.HostOf(opening.instance))));
    }
    plan_.openings.push_back(std::move(out));
  }

  void AddFillingWithoutOpening(uint32_t product_index) {
    const Product& product = products_[product_index];
    PlanOpening out;
    out.location = model_.Location(product.instance);
    out.guid = out.location.guid;
    out.name = TextOf(product.instance, attribute::kName);
    if (product.frame != kNoIndex) {
      out.wall = element_of_[product.frame];
    } else {
      model_.Emit(DiagnosticKind::kFillingWithoutOpening, product.instance,
                  fmt::format("{} fills no opening, so that no wall is known to hold it", model_.Label(product.instance)));
    }
    DescribeFilling(product_index, out);
    plan_.openings.push_back(std::move(out));
  }

  void ReadSpaces() {
    for (const uint32_t instance : model_.InstancesOf(IfcType::kIfcSpace)) {
      PlanSpace space;
      space.location = model_.Location(instance);
      space.guid = space.location.guid;
      space.name = TextOf(instance, attribute::kName);
      space.long_name = TextOf(instance, attribute::kSpatialLongName);
      space.storey = StoreyOf(instance);
      for (const ShapePart& part : PlacedBody(instance)) AppendSolid(part.solid, space.body);
      plan_.spaces.push_back(std::move(space));
    }
  }

  // Whole metres off, so that numbers in the file and in the plan differ by a plain amount.
  void MoveNearZero() {
    Eigen::AlignedBox3d walls, all;
    for (const PlanElement& element : plan_.elements) {
      if (element.kind == ElementKind::kGround) continue;
      const Eigen::AlignedBox3d box = Bounds(element.body);
      all.extend(box);
      if (IsWallLike(element.kind)) walls.extend(box);
    }
    const Eigen::AlignedBox3d& box = walls.isEmpty() ? all : walls;
    if (box.isEmpty() || box.center().cwiseAbs().maxCoeff() <= options_.far_origin_m) return;
    Vector3d origin = box.center().array().round();
    if (std::abs(origin.z()) <= options_.far_origin_m) origin.z() = 0;
    plan_.origin = origin;
    const auto move = [&origin](Solid& solid) {
      for (Vector3d& v : solid.vertices) v -= origin;
    };
    for (PlanElement& element : plan_.elements) {
      move(element.body);
      move(element.uncut);
      for (Arc& arc : element.arcs) arc.center -= origin.head<2>();
      if (!element.axis) continue;
      element.axis->first -= origin.head<2>();
      element.axis->second -= origin.head<2>();
    }
    for (PlanOpening& opening : plan_.openings) move(opening.body);
    for (PlanSpace& space : plan_.spaces) move(space.body);
    for (PlanStorey& storey : plan_.storeys) storey.elevation_m -= origin.z();
    model_.Emit(DiagnosticKind::kFarOrigin, kNone,
                fmt::format("the plan lies around ({}, {}, {}) m; it is moved near zero inside and written where it was", origin.x(), origin.y(), origin.z()));
  }

  void MakeStorey() {
    double low_m = 0;
    bool first = true;
    for (const PlanElement& element : plan_.elements) {
      if (!IsWallLike(element.kind) || element.body.empty()) continue;
      const double z = Bounds(element.body).min().z();
      low_m = first ? z : std::min(low_m, z);
      first = false;
    }
    model_.Emit(DiagnosticKind::kNoStorey, kNone, fmt::format("the file has no IfcBuildingStorey; one storey at {} m, under the lowest wall, holds everything", low_m));
    plan_.storeys.push_back({{}, "storey", {}, low_m});
    for (PlanElement& element : plan_.elements) element.storey = 0;
    for (PlanSpace& space : plan_.spaces) space.storey = 0;
  }

  const IfcModel& model_;
  const IfcOptions& options_;
  PlacementReader placements_;
  StyleReader styles_;
  ShapeReader shapes_;
  Relations relations_;
  ProductKinds kinds_;
  PlanIr plan_;
  std::vector<uint32_t> storey_of_;   // position in the plan, by instance
  std::vector<uint32_t> product_of_;  // by instance
  std::vector<Product> products_;
  std::vector<uint32_t> element_of_;  // by product
  std::vector<Opening> openings_;
};

}  // namespace

std::optional<PlanIr> ReadIfc(const Source& source, DiagnosticSink& diagnostics) { return ReadIfc(source, diagnostics, IfcOptions()); }

std::optional<PlanIr> ReadIfc(const Source& source, DiagnosticSink& diagnostics, const IfcOptions& options) {
  if (const std::string problem = options.Check(); !problem.empty()) {
    diagnostics.Emit(DiagnosticKind::kInternalError, {}, problem);
    return std::nullopt;
  }
  if (!IsSupported(source, diagnostics)) return std::nullopt;
  std::optional<IfcModel> model = IfcModel::Open(source.bytes, diagnostics);
  if (!model) return std::nullopt;
  ReadUnits(*model);
  PlanIr plan = Frontend(*model, options).Run();
  plan.source_path = source.path;
  plan.source_format = model->schema_name();
  plan.source_sha256 = source.sha256;
  return plan;
}

}  // namespace plumb::compiler
