// One storey of a plan from a drawing in metres: walls as solids, doors and windows, rooms' names. Heights are assumed.
#pragma once

#include <string>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/drawing/drawing.h"
#include "compiler/frontends/drawing/openings.h"
#include "compiler/frontends/drawing/wall_mass.h"
#include "compiler/ir/plan_ir.h"

namespace plumb::compiler {

// A drawing has no heights: these stand for them.
struct HeightOptions {
  double storey_m = 2.6;  // of walls
  double door_m = 2.05;   // of doors and passages
  double sill_m = 0.9;    // of windows
  double window_top_m = 2.1;
  [[nodiscard]] std::string Check() const;
};

struct DrawingOptions {
  MassOptions mass;
  OpeningOptions openings;
  HeightOptions heights;
  [[nodiscard]] std::string Check() const;
};

// Appends the storey with its elements, openings and spaces (named faces between the walls) to `plan`. False: too complex, and an error says so.
[[nodiscard]] bool AppendStorey(const Drawing& drawing, const PlanStorey& storey, const DrawingOptions& options, PlanIr& plan, DiagnosticSink& sink);

}  // namespace plumb::compiler
