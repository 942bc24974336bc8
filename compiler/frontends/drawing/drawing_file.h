// What every format that draws does with its drawing: rules for the layers, metres, an origin nearby, sheets, storeys.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.h"
#include "compiler/frontends/drawing/drawing.h"
#include "compiler/frontends/drawing/layer_rules.h"
#include "compiler/frontends/drawing/plan_from_drawing.h"
#include "compiler/ir/plan_ir.h"

namespace plumb::compiler {

struct DrawingFileOptions {
  DrawingOptions plan;
  std::string unit;     // mm, cm, m, in, ft; empty: as the file states, if that is plausible
  double scale_m = 0;   // of one unit of the file; 0: as `unit` or the file says
  std::string layers;   // a built-in set of layer rules or a TOML file; empty: the set that fits best
  int sheet = 0;        // of several plans on one sheet, from 1; 0: all of them, as storeys
  int max_depth = 16;   // of blocks and symbols within each other
  size_t max_paths = 4'000'000;  // of all of them unfolded
  [[nodiscard]] std::string Check() const;
  // Metres of one unit of the file; none: the file has to say.
  [[nodiscard]] std::optional<double> GivenScale() const;
};

// Those that `options` name, else the built-in set that fits `layers` best, which is said. None: there are no such rules, and an error says
// so.
[[nodiscard]] std::optional<LayerRules> RulesFor(const std::vector<LayerWeight>& layers, const DrawingFileOptions& options,
                                                 DiagnosticSink& sink);

// Says so if nothing in the drawing has usual sizes where its unit is `metres` long, as the options have it.
void CheckGivenScale(double metres, const Drawing& drawing, DiagnosticSink& sink);

void ScaleDrawing(double metres, Drawing& drawing);

// Appends the storey of a drawing in metres, or its storeys if it has several sheets, to `plan`, the lowest one at `storey.elevation_m`.
// False: no plan comes of it, and an error says so.
[[nodiscard]] bool AppendDrawing(Drawing drawing, const PlanStorey& storey, const DrawingFileOptions& options, PlanIr& plan,
                                 DiagnosticSink& sink);

}  // namespace plumb::compiler
