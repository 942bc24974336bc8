#include "compiler/frontends/ifc/ifc_storeys.h"

#include <algorithm>
#include <utility>

namespace plumb::compiler {
namespace {

static_assert(kNoIndex == StepFile::kNone, "what InstanceMap gives for none");

PlanStorey ReadStorey(const IfcModel& model, uint32_t instance, PlacementReader& placements) {
  const IfcInstance storey = model.Get(instance);
  PlanStorey out;
  out.location = model.Location(instance);
  out.guid = out.location.guid;
  out.name = storey[attribute::kName].Text();
  if (out.name.empty()) out.name = storey[attribute::kSpatialLongName].Text();
  const StepValue placement = storey[attribute::kPlacement];
  out.elevation_m =
      placement.is_null() ? model.Length(storey, attribute::kStoreyElevation) : placements.ObjectPlacement(placement).translation().z();
  return out;
}

}  // namespace

std::vector<PlanStorey> StoreyTable::Read(const IfcModel& model, PlacementReader& placements) {
  std::vector<std::pair<uint32_t, PlanStorey>> found;
  for (const uint32_t instance : model.InstancesOf(IfcType::kIfcBuildingStorey)) {
    found.emplace_back(instance, ReadStorey(model, instance, placements));
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.second.elevation_m < b.second.elevation_m; });
  std::vector<PlanStorey> out;
  for (auto& [instance, storey] : found) {
    position_of_.Set(instance, static_cast<uint32_t>(out.size()));
    out.push_back(std::move(storey));
  }
  return out;
}

}  // namespace plumb::compiler
