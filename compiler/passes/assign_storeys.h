// First pass: every element and space gets a storey, by the source where geometry bears it out, else by geometry.
#pragma once

#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/ir/floor_ir.h"

namespace plumb::compiler {

struct StoreyOptions {
  double min_storey_height_m = 1.5;  // storeys closer than this to the one below share its map (landings, split levels)
  double containment_slack_m = 1.0;  // an element this far outside its storey's band is contained in the wrong one
  [[nodiscard]] std::string Check() const;
};

// Sets PlanElement::storey and PlanSpace::storey. A plan without storeys gets one at its lowest wall. An element whose solid is
// nowhere near the storey it is contained in moves to the one its foot stands on, with a diagnostic.
void AssignStoreys(PlanIr& plan, const StoreyOptions& options, DiagnosticSink& sink);

// Groups storeys (sorted by elevation) into levels. `section_height_m` is counted from the highest storey of a level.
[[nodiscard]] std::vector<Level> GroupStoreys(const PlanIr& plan, double section_height_m, const StoreyOptions& options);

// The level whose zero is the highest at or below z_m + slack_m; the lowest one if there is none.
[[nodiscard]] size_t LevelAt(const std::vector<Level>& levels, double z_m, double slack_m);

}  // namespace plumb::compiler
