#include "compiler/frontends/ifc/ifc_opening_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "compiler/frontends/ifc/ifc_openings.h"

namespace plumb::compiler {
namespace {

constexpr double kApart_m = 1e-3;  // openings this far apart are cut in one step: much more than the planes that cut are thick

}  // namespace

OpeningTable::OpeningTable(const IfcModel& model, PlacementReader& placements, const Relations& relations, ProductTable& products,
                           const IfcOptions& options)
    : model_(model), placements_(placements), relations_(relations), products_(products), options_(options) {
  of_product_.resize(products.size());
  std::vector<uint32_t> instances;
  for (const IfcType type : {IfcType::kIfcOpeningElement, IfcType::kIfcOpeningStandardCase, IfcType::kIfcVoidingFeature}) {
    const auto of_type = model.InstancesOf(type);
    instances.insert(instances.end(), of_type.begin(), of_type.end());
  }
  std::sort(instances.begin(), instances.end());
  for (const uint32_t instance : instances) {
    if (relations.HostOf(instance) == StepFile::kNone) continue;
    Opening opening;
    opening.instance = instance;
    opening.product = products.Root(relations.HostOf(instance));
    for (ShapePart& part : products.PlacedBody(instance)) opening.solids.push_back(std::move(part.solid));
    if (opening.solids.empty()) {
      model.Emit(DiagnosticKind::kOpeningWithoutBody, instance,
                 fmt::format("the opening {} has no body that can be read; it cuts nothing", model.Label(instance)));
    }
    if (opening.product != kNoIndex) of_product_[opening.product].push_back(openings_.size());
    openings_.push_back(std::move(opening));
  }
}

std::vector<Opening*> OpeningTable::Cutting(uint32_t product) {
  constexpr int kMaxSteps = 8;
  std::vector<uint32_t> hosts = {product};
  uint32_t at = relations_.WholeOf(products_[product].instance);
  for (int step = 0; step < kMaxSteps && at != StepFile::kNone; ++step, at = relations_.WholeOf(at)) {
    const uint32_t p = products_.Root(at);
    if (p != kNoIndex && !products_[p].has_body) hosts.push_back(p);
  }
  std::vector<size_t> numbers;
  for (const uint32_t host : hosts) numbers.insert(numbers.end(), of_product_[host].begin(), of_product_[host].end());
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<Opening*> out;
  for (const size_t o : numbers) out.push_back(&openings_[o]);
  return out;
}

void OpeningTable::Cut(uint32_t product, ShapeParts& parts) {
  std::vector<Tool> tools;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (Opening* opening : Cutting(product)) {
    for (const Solid& solid : opening->solids) {
      tools.push_back({opening, &solid});
      boxes.push_back(Bounds(solid));
    }
  }
  std::vector<Tool> group;
  for (const std::vector<size_t>& numbers : GroupsApart(boxes, kApart_m)) {
    group.clear();
    for (const size_t number : numbers) group.push_back(tools[number]);
    for (ShapePart& part : parts) {
      if (!CutGroup(product, group, part.solid)) return;
    }
  }
  std::erase_if(parts, [](const ShapePart& part) { return part.solid.empty(); });
}

bool OpeningTable::CutGroup(uint32_t product, std::span<const Tool> group, Solid& body) {
  const Eigen::AlignedBox3d box = Bounds(body);
  std::vector<Tool> tools;
  std::copy_if(group.begin(), group.end(), std::back_inserter(tools),
               [&](const Tool& tool) { return box.intersects(Bounds(*tool.solid)); });
  if (tools.size() > 1) {
    if (!SpendCut(body, tools)) return false;
    std::vector<const Solid*> solids;
    for (const Tool& tool : tools) solids.push_back(tool.solid);
    if (const auto cuts = CutApart(solids, options_, body)) {
      for (size_t t = 0; t < tools.size(); ++t) tools[t].opening->cuts |= (*cuts)[t];
      return true;
    }
  }
  for (const Tool& tool : tools) {
    if (!SpendCut(body, {&tool, 1})) return false;
    const CutPair pair = {products_[product].instance, tool.opening->instance};
    tool.opening->cuts |= CutOpening(model_, pair, options_, *tool.solid, body);
  }
  return true;
}

// Each cut leaves more triangles to the next: thousands of openings on top of one another would take hours.
bool OpeningTable::SpendCut(const Solid& body, std::span<const Tool> tools) {
  cut_triangles_ += body.triangles.size();
  for (const Tool& tool : tools) cut_triangles_ += tool.solid->triangles.size();
  if (cut_triangles_ <= options_.max_cut_triangles) return true;
  if (!model_.is_too_complex()) {
    const uint32_t opening = tools.front().opening->instance;
    model_.Emit(DiagnosticKind::kPlanTooComplex, opening,
                fmt::format("the openings up to {} take too long to cut out of their walls: over {} triangles, counted for each cut",
                            model_.Label(opening), options_.max_cut_triangles));
  }
  return false;
}

void OpeningTable::RestoreUncut(uint32_t product, Solid& uncut) {
  const Solid before = uncut;
  for (const size_t o : of_product_[product]) {
    Opening& opening = openings_[o];
    if (opening.cuts) continue;
    const StepValue placement = model_.Get(products_[product].instance)[attribute::kPlacement];
    for (const Solid& solid : opening.solids) {
      const Solid piece = PieceCutBefore(solid, placements_.ObjectPlacement(placement), before, options_);
      opening.cut_before |= !piece.empty();
      AppendSolid(piece, uncut);
    }
  }
}

void OpeningTable::AssignFillings() {
  InstanceMap filling_of;  // product, by opening
  std::vector<char> is_filling(products_.size(), 0);
  for (uint32_t p = 0; p < products_.size(); ++p) {
    const uint32_t opening = relations_.OpeningOf(products_[p].instance);
    if (opening == StepFile::kNone) continue;
    is_filling[p] = 1;
    const uint32_t filling = filling_of[opening];
    // Of a door and a window in one opening the door counts: through it goes the way.
    if (filling == kNoIndex || products_[filling].kind != ElementKind::kDoor) filling_of.Set(opening, p);
  }
  for (Opening& opening : openings_) opening.filling = filling_of[opening.instance];
  AssignByPlace(is_filling);
}

void OpeningTable::AssignByPlace(const std::vector<char>& is_filling) {
  std::vector<FillCandidate> fillings, openings;
  for (uint32_t p = 0; p < products_.size(); ++p) {
    const Product& product = products_[p];
    if (!MayFill(product.kind) || is_filling[p] != 0 || product.frame != kNoIndex || product.whole != kNoIndex) continue;
    fillings.push_back({p, product.box});
  }
  for (uint32_t o = 0; o < openings_.size(); ++o) {
    if (openings_[o].filling != kNoIndex || openings_[o].solids.empty()) continue;
    Eigen::AlignedBox3d box;
    for (const Solid& solid : openings_[o].solids) box.extend(Bounds(solid));
    openings.push_back({o, box});
  }
  for (const auto& [product, o] : MatchFillings(fillings, openings, options_.fill_min_overlap)) {
    Opening& opening = openings_[o];
    if (opening.product == product) continue;
    opening.filling = product;
    const std::string label = model_.Label(products_[product].instance);
    model_.Emit(DiagnosticKind::kFillingInferred, products_[product].instance,
                fmt::format("{} fills no opening by IfcRelFillsElement; it stands in {}, which is taken for it", label,
                            model_.Label(opening.instance)));
  }
}

}  // namespace plumb::compiler
