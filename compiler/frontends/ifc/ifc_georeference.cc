#include "compiler/frontends/ifc/ifc_georeference.h"

#include <fmt/format.h>

#include <cmath>

namespace plumb::compiler {

void CheckGeoreference(const IfcModel& model, const Eigen::Vector3d& plan_origin_m) {
  constexpr double kNear = 0.1;  // of the distance to zero: sites are kilometres wide, map coordinates hundreds of them
  const Eigen::Vector2d origin_m = plan_origin_m.head<2>();
  for (const uint32_t index : model.InstancesOf(IfcType::kIfcMapConversion)) {
    const IfcInstance conversion = model.Get(index);
    const Eigen::Vector2d offset(model.Number(conversion, attribute::kMapEastings), model.Number(conversion, attribute::kMapNorthings));
    // In the map's unit, which many files leave unstated: the metre or the file's own.
    for (const double scale : {model.length_scale(), 1.0}) {
      const Eigen::Vector2d offset_m = offset * scale;
      if (!((offset_m - origin_m).norm() < kNear * origin_m.norm())) continue;
      model.Emit(DiagnosticKind::kGeoreferencedTwice, index,
                 fmt::format("the placements put the plan around ({:.0f}, {:.0f}) m, and {} moves it by ({:.0f}, {:.0f}) m once more", origin_m.x(),
                             origin_m.y(), model.Label(index), offset_m.x(), offset_m.y()),
                 "the plan frame is taken before the map conversion; export with one of the two");
      return;
    }
  }
}

}  // namespace plumb::compiler
