#include "compiler/frontends/ifc/ifc_frontend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "compiler/frontends/ifc/ifc_doors.h"
#include "compiler/frontends/ifc/ifc_georeference.h"
#include "compiler/frontends/ifc/ifc_model.h"
#include "compiler/frontends/ifc/ifc_opening_table.h"
#include "compiler/frontends/ifc/ifc_origin.h"
#include "compiler/frontends/ifc/ifc_placement.h"
#include "compiler/frontends/ifc/ifc_product_table.h"
#include "compiler/frontends/ifc/ifc_relations.h"
#include "compiler/frontends/ifc/ifc_shape.h"
#include "compiler/frontends/ifc/ifc_storeys.h"
#include "compiler/frontends/ifc/ifc_units.h"
#include "compiler/frontends/ifc/ifc_wall_proxies.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr uint32_t kNone = StepFile::kNone;

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
        products_(model, placements_, styles_, shapes_, relations_, options),
        openings_(model, placements_, relations_, products_, options),
        doors_(model, placements_, relations_) {}

  PlanIr Run() {
    if (model_.is_too_complex()) return {};
    if (!HasBuilding()) {
      model_.Emit(
          DiagnosticKind::kNoBuilding, kNone,
          fmt::format("none of the {} instances of the file is a building, a storey, a space or a building element", model_.size()));
      return {};
    }
    ReadNorth();
    plan_.storeys = storeys_.Read(model_, placements_);
    MakeElements();
    MakeOpenings();
    ReadSpaces();
    if (MoveNearZero(options_.far_origin_m, plan_)) {
      model_.Emit(DiagnosticKind::kFarOrigin, kNone,
                  fmt::format("the plan lies around ({}, {}, {}) m; it is moved near zero inside and written where it was",
                              plan_.origin.x(), plan_.origin.y(), plan_.origin.z()));
      CheckGeoreference(model_, plan_.origin);
    }
    return std::move(plan_);
  }

 private:
  bool HasBuilding() const {
    constexpr std::array kSpatial = {IfcType::kIfcSite, IfcType::kIfcBuilding, IfcType::kIfcBuildingStorey, IfcType::kIfcSpace};
    return products_.size() > 0 ||
           std::any_of(kSpatial.begin(), kSpatial.end(), [&](IfcType type) { return !model_.InstancesOf(type).empty(); });
  }

  std::string TextOf(uint32_t instance, size_t attribute_index) const { return model_.Get(instance)[attribute_index].Text(); }

  // Of the first context that states it; without, the plan's y axis may or may not be north.
  void ReadNorth() {
    for (const uint32_t context : model_.InstancesOf(IfcType::kIfcGeometricRepresentationContext)) {
      const StepValue north = model_.Get(context)[attribute::kContextTrueNorth];
      if (!model_.Follow(north)) continue;
      const Eigen::Vector3d direction = placements_.Direction(north, Eigen::Vector3d::UnitY());
      plan_.true_north_rad = std::atan2(direction.y(), direction.x());
      return;
    }
  }

  PlanElement BaseElement(const Product& product) const {
    PlanElement element;
    element.kind = product.kind;
    element.location = model_.Location(product.instance);
    element.guid = element.location.guid;
    element.type = element.location.type;
    element.name = TextOf(product.instance, attribute::kName);
    element.storey = storeys_.Of(relations_.StoreyOf(product.instance));
    element.external = relations_.IsExternal(product.instance).value_or(false);
    if (product.kind == ElementKind::kDoor) element.leaves = doors_.Leaves(product.instance);
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
                  fmt::format("the body of {} is not closed: its edges do not pair; openings cut its surface only",
                              model_.Label(product.instance)));
      return;
    }
  }

  void MakeElements() {
    element_of_.assign(products_.size(), kNoIndex);
    plan_.elements.reserve(products_.size() + products_.CountFillings());  // of a door or window, its panes are one more
    for (uint32_t p = 0; p < products_.size(); ++p) {
      const Product& product = products_[p];
      if (product.whole != kNoIndex) continue;
      if (product.parts.empty() && !FillsOpenings(product.kind) && !IsMadeOfFillings(product)) {
        ReportNoBody(product);
        continue;
      }
      PlanElement element = BaseElement(product);
      CheckGuid(product, element.guid);
      if (IsWallLike(product.kind)) {
        DescribeWall(product, element);
        CheckWall(product);
      }
      if (HasUncut(p)) {
        for (const ShapePart& part : product.parts) AppendSolid(part.solid, element.uncut);
        for (const uint32_t filling : product.fillings) {
          for (const ShapePart& part : products_[filling].parts) AppendSolid(part.solid, element.uncut);
        }
      }
      ShapeParts parts = products_.TakeParts(p);
      openings_.Cut(p, parts);
      if (IsWallLike(product.kind) && element.arcs.empty()) openings_.RestoreUncut(p, element.uncut);
      AddElements(p, std::move(element), std::move(parts));
    }
  }

  // A shop front that is nothing but its doors.
  bool IsMadeOfFillings(const Product& product) const {
    return product.kind == ElementKind::kCurtainWall &&
           std::any_of(product.fillings.begin(), product.fillings.end(), [&](uint32_t f) { return products_[f].has_body; });
  }

  bool HasUncut(uint32_t p) const {
    const ElementKind kind = products_[p].kind;
    return IsWallLike(kind) || kind == ElementKind::kColumn || (kind == ElementKind::kProxy && ActsAsWall(p));
  }

  bool ActsAsWall(uint32_t p) const {
    const Product& product = products_[p];
    if (!IsWallShaped(product.parts)) return false;
    const bool is_named =
        IsWallName(TextOf(product.instance, attribute::kName)) || IsWallName(TextOf(product.instance, attribute::kObjectType));
    if (!is_named && !openings_.HasOpenings(p)) return false;
    model_.Emit(
        DiagnosticKind::kProxyAsWall, product.instance,
        fmt::format("{} is taken for a wall by its shape and its {}", model_.Label(product.instance), is_named ? "name" : "openings"));
    return true;
  }

  void CheckGuid(const Product& product, const std::string& guid) {
    if (guid.empty() || guids_.insert(guid).second) return;
    model_.Emit(DiagnosticKind::kDuplicateGlobalId, product.instance,
                fmt::format("the GlobalId of {} is that of an earlier element, too", model_.Label(product.instance)));
  }

  void ReportNoBody(const Product& product) const {
    if (IsWallLike(product.kind)) {
      model_.Emit(DiagnosticKind::kWallWithoutBody, product.instance,
                  fmt::format("{} has no body that can be read; it is left out", model_.Label(product.instance)));
    }
  }

  void AddElements(uint32_t product_index, PlanElement element, ShapeParts parts) {
    Solid glass;
    for (ShapePart& part : parts) AppendSolid(std::move(part.solid), part.look == Look::kGlass ? glass : element.body);
    for (Solid* solid : {&element.body, &element.uncut, &glass}) ShrinkSolid(*solid);
    element_of_[product_index] = static_cast<uint32_t>(plan_.elements.size());
    if (element.body.empty() && !glass.empty()) {
      element.material = Material::kGlass;
      element.body = std::move(glass);
      plan_.elements.push_back(std::move(element));
      return;
    }
    if (glass.empty()) {
      plan_.elements.push_back(std::move(element));
      return;
    }
    Solid body = std::move(element.body), uncut = std::move(element.uncut);
    element.body = element.uncut = {};
    PlanElement panes = element;
    element.body = std::move(body);
    element.uncut = std::move(uncut);
    plan_.elements.push_back(std::move(element));
    // So that one wall stays one element, the panes in it are windows.
    if (IsWallLike(panes.kind)) panes.kind = ElementKind::kWindow;
    panes.material = Material::kGlass;
    panes.body = std::move(glass);
    panes.axis.reset();
    panes.arcs.clear();
    panes.leaves.clear();
    plan_.elements.push_back(std::move(panes));
  }

  void DescribeFilling(uint32_t product, PlanOpening& opening) const {
    const IfcInstance filling = model_.Get(products_[product].instance);
    opening.filling = element_of_[product];
    if (!FillsOpenings(products_[product].kind)) return;
    if (const double width_m = model_.Length(filling, attribute::kOverallWidth); width_m > 0) opening.width_m = width_m;
    if (const double height_m = model_.Length(filling, attribute::kOverallHeight); height_m > 0) opening.height_m = height_m;
  }

  void MakeOpenings() {
    openings_.AssignFillings();
    std::vector<char> is_filling(products_.size(), 0);
    for (const Opening& opening : openings_.all()) {
      AddOpening(opening);
      if (opening.filling != kNoIndex) is_filling[opening.filling] = 1;
    }
    for (uint32_t p = 0; p < products_.size(); ++p) {
      if (FillsOpenings(products_[p].kind) && is_filling[p] == 0) AddFillingWithoutOpening(p);
    }
  }

  void AddOpening(const Opening& opening) {
    PlanOpening out;
    out.location = model_.Location(opening.instance);
    out.guid = out.location.guid;
    out.name = TextOf(opening.instance, attribute::kName);
    out.wall = opening.product == kNoIndex ? kNoIndex : element_of_[opening.product];
    for (const Solid& solid : opening.solids) AppendSolid(solid, out.body);
    if (opening.filling != kNoIndex) DescribeFilling(opening.filling, out);
    if (!opening.cuts && !opening.cut_before && !opening.solids.empty() && out.wall != kNoIndex) {
      model_.Emit(DiagnosticKind::kOpeningMissesHost, opening.instance,
                  fmt::format("the opening {} does not meet {}, which it should cut", model_.Label(opening.instance),
                              model_.Label(relations_.HostOf(opening.instance))));
    }
    plan_.openings.push_back(std::move(out));
  }

  void AddFillingWithoutOpening(uint32_t product_index) {
    const Product& product = products_[product_index];
    PlanOpening out;
    out.location = model_.Location(product.instance);
    out.guid = out.location.guid;
    out.name = TextOf(product.instance, attribute::kName);
    const uint32_t shared_opening = relations_.OpeningOf(product.instance);  // that something else fills, too
    const uint32_t host = shared_opening == kNone ? product.frame : products_.Root(relations_.HostOf(shared_opening));
    if (host != kNoIndex) {
      out.wall = element_of_[host];
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
      space.storey = storeys_.Of(relations_.StoreyOf(instance));
      for (ShapePart& part : products_.PlacedBody(instance)) AppendSolid(std::move(part.solid), space.body);
      plan_.spaces.push_back(std::move(space));
    }
  }

  const IfcModel& model_;
  const IfcOptions& options_;
  PlacementReader placements_;
  StyleReader styles_;
  ShapeReader shapes_;
  Relations relations_;
  StoreyTable storeys_;
  ProductTable products_;
  OpeningTable openings_;
  DoorReader doors_;
  PlanIr plan_;
  std::set<std::string> guids_;
  std::vector<uint32_t> element_of_;  // by product
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
  if (!model || model->is_refused()) return std::nullopt;
  ReadUnits(*model);
  PlanIr plan = Frontend(*model, options).Run();
  if (model->is_refused()) return std::nullopt;
  plan.source_path = source.path;
  plan.source_format = model->schema_name();
  plan.source_sha256 = source.sha256;
  return plan;
}

}  // namespace plumb::compiler
