#include "compiler/frontends/ifc/ifc_georeference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb::compiler {
namespace {

struct Conversion {
  uint32_t instance;
  Eigen::Vector2d offset;  // eastings and northings
};

bool IsNamed(const std::string& name, std::string_view lower) {
  return std::equal(name.begin(), name.end(), lower.begin(), lower.end(), [](unsigned char a, char b) { return std::tolower(a) == b; });
}

// IFC2X3 has no IfcMapConversion: its users agreed on a property set with the same names.
std::optional<Conversion> FromPropertySet(const IfcModel& model, uint32_t index) {
  const IfcInstance set = model.Get(index);
  if (!IsNamed(set[attribute::kPropertySetName].Text(), "epset_mapconversion")) return std::nullopt;
  std::optional<double> eastings, northings;
  for (const StepValue item : set[attribute::kPropertySetProperties].Items()) {
    const IfcInstance property = model.Follow(item);
    if (!property || property.type != IfcType::kIfcPropertySingleValue) continue;
    const std::string name = property[attribute::kPropertyName].Text();
    if (IsNamed(name, "eastings")) eastings = property[attribute::kPropertyValue].Real();
    if (IsNamed(name, "northings")) northings = property[attribute::kPropertyValue].Real();
  }
  if (!eastings || !northings) return std::nullopt;
  return Conversion{index, {*eastings, *northings}};
}

std::vector<Conversion> Conversions(const IfcModel& model) {
  std::vector<Conversion> out;
  for (const uint32_t index : model.InstancesOf(IfcType::kIfcMapConversion)) {
    const IfcInstance conversion = model.Get(index);
    out.push_back({index, {model.Number(conversion, attribute::kMapEastings), model.Number(conversion, attribute::kMapNorthings)}});
  }
  for (const uint32_t index : model.InstancesOf(IfcType::kIfcPropertySet)) {
    if (const auto conversion = FromPropertySet(model, index)) out.push_back(*conversion);
  }
  return out;
}

}  // namespace

void CheckGeoreference(const IfcModel& model, const Eigen::Vector3d& plan_origin_m) {
  constexpr double kNear = 0.1;  // of the distance to zero: sites are kilometres wide, map coordinates hundreds of them
  const Eigen::Vector2d origin_m = plan_origin_m.head<2>();
  for (const auto& [instance, offset] : Conversions(model)) {
    // In the map's unit, which many files leave unstated: the metre or the file's own.
    for (const double scale : {model.length_scale(), 1.0}) {
      const Eigen::Vector2d offset_m = offset * scale;
      if (!((offset_m - origin_m).norm() < kNear * origin_m.norm())) continue;
      model.Emit(DiagnosticKind::kGeoreferencedTwice, instance,
                 fmt::format("the placements put the plan around ({:.0f}, {:.0f}) m, and {} moves it by ({:.0f}, {:.0f}) m once more",
                             origin_m.x(), origin_m.y(), model.Label(instance), offset_m.x(), offset_m.y()),
                 "the plan frame is taken before the map conversion; export with one of the two");
      return;
    }
  }
}

}  // namespace plumb::compiler
