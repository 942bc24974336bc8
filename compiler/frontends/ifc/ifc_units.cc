#include "compiler/frontends/ifc/ifc_units.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace plumb::compiler {
namespace {

struct Prefix {
  std::string_view name;
  double factor;
};
constexpr Prefix kPrefixes[] = {{"EXA", 1e18},  {"PETA", 1e15},  {"TERA", 1e12},   {"GIGA", 1e9},   {"MEGA", 1e6},   {"KILO", 1e3},
                                {"HECTO", 1e2}, {"DECA", 1e1},   {"DECI", 1e-1},   {"CENTI", 1e-2}, {"MILLI", 1e-3}, {"MICRO", 1e-6},
                                {"NANO", 1e-9}, {"PICO", 1e-12}, {"FEMTO", 1e-15}, {"ATTO", 1e-18}};

// SI units in one of the kind's base unit (metre, radian); 0 for what is no sensible unit.
double ScaleOf(const IfcModel& model, const IfcInstance& unit, int depth) {
  constexpr int kMaxDepth = 8;
  if (!unit || depth > kMaxDepth) return 0;
  switch (unit.type) {
    case IfcType::kIfcSIUnit: {
      const std::string_view prefix = unit[attribute::kSiPrefix].Enumeration();
      if (prefix.empty()) return 1;
      for (const Prefix& p : kPrefixes) {
        if (p.name == prefix) return p.factor;
      }
      return 0;
    }
    case IfcType::kIfcConversionBasedUnit:
    case IfcType::kIfcConversionBasedUnitWithOffset: {
      const IfcInstance measure = model.Follow(unit[attribute::kConversionFactor]);
      if (!measure) return 0;
      const double scale = ScaleOf(model, model.Follow(measure[attribute::kMeasureUnit]), depth + 1);
      return measure[attribute::kMeasureValue].Real().value_or(0) * scale;
    }
    default: return 0;
  }
}

IfcInstance FindAssignment(const IfcModel& model) {
  for (const uint32_t project : model.InstancesOf(IfcType::kIfcProject)) {
    if (IfcInstance units = model.Follow(model.Get(project)[attribute::kProjectUnits])) return units;
  }
  const auto all = model.InstancesOf(IfcType::kIfcUnitAssignment);
  return all.empty() ? IfcInstance() : model.Get(all[0]);
}

}  // namespace

void ReadUnits(IfcModel& model) {
  double length = 0, angle = 0;
  const IfcInstance assignment = FindAssignment(model);
  if (assignment) {
    for (const StepValue item : assignment[attribute::kAssignedUnits].Items()) {
      const IfcInstance unit = model.Follow(item);
      if (!unit) continue;
      const std::string_view kind = unit[attribute::kUnitType].Enumeration();
      double* scale = kind == "LENGTHUNIT" ? &length : kind == "PLANEANGLEUNIT" ? &angle : nullptr;
      if (scale == nullptr) continue;
      *scale = ScaleOf(model, unit, 0);
      if (*scale > 0 && std::isfinite(*scale)) continue;
      *scale = 0;
      model.Emit(DiagnosticKind::kUnitNotRead, unit.index, fmt::format("the unit {} cannot be resolved", model.Label(unit.index)));
    }
  }
  if (length == 0) model.Emit(DiagnosticKind::kNoLengthUnit, assignment.index, "no length unit is assigned; lengths are taken as metres");
  model.SetUnits(length > 0 ? length : 1, angle > 0 ? angle : 1);
}

}  // namespace plumb::compiler
