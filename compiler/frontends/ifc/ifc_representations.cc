#include "compiler/frontends/ifc/ifc_representations.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace plumb::compiler {
namespace {

constexpr int kBoxRank = 1;

// How well a representation serves as the body: higher is better, 0 not at all.
int BodyRank(const IfcInstance& representation) {
  const std::string id = representation[attribute::kRepresentationIdentifier].Text();
  const std::string type = representation[attribute::kRepresentationType].Text();
  constexpr std::array<std::string_view, 9> kNoBody = {"Axis", "FootPrint", "Annotation", "Profile", "Clearance",
                                                       "CoG",  "Lighting",  "Reference",  "Plan"};
  if (std::find(kNoBody.begin(), kNoBody.end(), id) != kNoBody.end()) return 0;
  if (type == "BoundingBox" || id == "Box") return kBoxRank;
  if (id == "Body") return 5;
  if (id == "Facetation" || id == "Body-Fallback" || id == "Body-FallBack" || id == "Tessellation") return 4;
  constexpr std::array<std::string_view, 12> kSolid = {
      "SweptSolid",   "AdvancedSweptSolid",   "Clipping",  "Brep",         "AdvancedBrep", "CSG", "SurfaceModel", "SolidModel",
      "Tessellation", "MappedRepresentation", "Surface3D", "AttributeBody"};
  return std::find(kSolid.begin(), kSolid.end(), type) != kSolid.end() ? 3 : 0;
}

std::vector<IfcInstance> Representations(const IfcModel& model, const IfcInstance& definition_shape) {
  std::vector<IfcInstance> out;
  if (!definition_shape || definition_shape.type != IfcType::kIfcProductDefinitionShape) return out;
  for (const StepValue item : definition_shape[attribute::kShapeRepresentations].Items()) {
    if (const IfcInstance representation = model.Follow(item)) out.push_back(representation);
  }
  return out;
}

}  // namespace

std::vector<BodyRepresentation> BodyRepresentations(const IfcModel& model, const IfcInstance& definition_shape) {
  std::vector<std::pair<int, IfcInstance>> ranked;
  for (const IfcInstance& representation : Representations(model, definition_shape)) {
    if (representation.type != IfcType::kIfcShapeRepresentation) continue;
    const int rank = BodyRank(representation);
    if (rank > 0) ranked.emplace_back(rank, representation);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<BodyRepresentation> out;
  for (const auto& [rank, representation] : ranked) out.push_back({representation, rank == kBoxRank});
  return out;
}

std::vector<IfcInstance> AxisCurves(const IfcModel& model, const IfcInstance& definition_shape) {
  std::vector<IfcInstance> out;
  for (const IfcInstance& representation : Representations(model, definition_shape)) {
    if (representation[attribute::kRepresentationIdentifier].Text() != "Axis") continue;
    const StepItems items = representation[attribute::kRepresentationItems].Items();
    if (items.empty()) continue;
    const IfcInstance curve = model.Follow(*items.begin());
    const bool is_curve = curve && curve.type != IfcType::kIfcMappedItem && curve.type != IfcType::kIfcGeometricSet &&
                          curve.type != IfcType::kIfcGeometricCurveSet;
    if (is_curve) out.push_back(curve);
  }
  return out;
}

}  // namespace plumb::compiler
