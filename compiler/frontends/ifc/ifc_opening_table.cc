#include "compiler/frontends/ifc/ifc_opening_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/frontends/ifc/ifc_openings.h"

namespace plumb::compiler {

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
    if (p != kNoIndex && products_[p].parts.empty()) hosts.push_back(p);
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
  for (Opening* opening : Cutting(product)) {
    for (const Solid& tool : opening->solids) {
      for (ShapePart& part : parts) {
        if (!SpendCut(part.solid, tool, opening->instance)) return;
        opening->cuts |= CutOpening(model_, {products_[product].instance, opening->instance}, options_, tool, part.solid);
      }
    }
  }
  std::erase_if(parts, [](const ShapePart& part) { return part.solid.empty(); });
}

// Each cut leaves more triangles to the next: thousands of openings in one wall would take hours.
bool OpeningTable::SpendCut(const Solid& body, const Solid& tool, uint32_t opening) {
  cut_triangles_ += body.triangles.size() + tool.triangles.size();
  if (cut_triangles_ <= options_.max_cut_triangles) return true;
  if (!model_.is_too_complex()) {
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
  std::vector<uint32_t> filling_of(model_.size(), kNoIndex);  // product, by opening instance
  std::vector<char> is_filling(products_.size(), 0);
  for (uint32_t p = 0; p < products_.size(); ++p) {
    const uint32_t opening = relations_.OpeningOf(products_[p].instance);
    if (opening == StepFile::kNone) continue;
    is_filling[p] = 1;
    uint32_t& filling = filling_of[opening];
    // Of a door and a window in one opening the door counts: through it goes the way.
    if (filling == kNoIndex || products_[filling].kind != ElementKind::kDoor) filling = p;
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
