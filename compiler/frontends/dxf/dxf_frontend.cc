#include "compiler/frontends/dxf/dxf_frontend.h"

#include <fmt/format.h>

#include <array>

#include "compiler/frontends/drawing/arc_steps.h"
#include "compiler/frontends/drawing/units.h"
#include "compiler/frontends/dxf/dxf_document.h"
#include "compiler/frontends/dxf/dxf_unfold.h"

namespace plumb::compiler {
namespace {

constexpr double kSagitta_m = 0.001;  // of the steps along arcs

// $INSUNITS by number; others are no units that buildings are drawn in.
constexpr std::array<const char*, 15> kInsunits = {"", "in", "ft", "", "mm", "cm", "m", "km", "", "", "yd", "", "", "", "dm"};

std::optional<LengthUnit> StatedUnit(const DxfDocument& document) {
  if (!document.insunits || *document.insunits < 0 || *document.insunits >= static_cast<int>(kInsunits.size())) return std::nullopt;
  return FindUnit(kInsunits[static_cast<size_t>(*document.insunits)]);
}

// Of a plan on its sheet or in its file.
class Frontend {
 public:
  Frontend(const Source& source, const DrawingFileOptions& options, DiagnosticSink& sink) : source_(source), options_(options), sink_(sink) {}

  bool Run(const PlanStorey& storey, PlanIr& plan) {
    const std::optional<DxfDocument> document = ReadDxfDocument(source_.bytes, {}, sink_);
    if (!document) return false;
    for (const auto& [type, count] : document->not_read)
      sink_.Emit(DiagnosticKind::kEntityNotRead, {}, fmt::format("{} entities of type {} are not read", count, type));
    const std::optional<LayerRules> rules = RulesFor(WeighLayers(*document), options_, sink_);
    if (!rules) return false;
    std::optional<Drawing> drawing = Unfold(*document, *rules, {options_.max_depth, options_.max_paths, 100'000}, sink_);
    if (!drawing) return false;
    if (drawing->paths.empty()) {
      sink_.Emit(DiagnosticKind::kNothingDrawn, {}, "the drawing has no lines in its model space that could be walls");
      return false;
    }
    ToMetres(*document, *drawing);
    return AppendDrawing(std::move(*drawing), storey, options_, plan, sink_);
  }

 private:
  void ToMetres(const DxfDocument& document, Drawing& drawing) {
    double metres = 1;
    if (const auto given = options_.GivenScale()) {
      metres = *given;
      CheckGivenScale(metres, drawing, sink_);
    } else {
      const std::optional<LengthUnit> stated = StatedUnit(document);
      const UnitChoice choice = ChooseUnit(MeasureSizes(drawing), stated);
      metres = choice.unit.metres;
      if (stated && !choice.stated_holds) {
        sink_.Emit(DiagnosticKind::kUnitContradicted, {},
                   fmt::format("the file states {}, but {}; {} is taken", stated->name, choice.reason, choice.unit.name), "--unit overrides");
      } else if (!stated) {
        sink_.Emit(DiagnosticKind::kUnitGuessed, {}, fmt::format("the file states no unit ({}); {}; {} is taken", Measurement(document), choice.reason, choice.unit.name), "--unit overrides");
      }
    }
    ScaleDrawing(metres, drawing);
    RefineArcSteps(kSagitta_m, drawing);
  }

  static const char* Measurement(const DxfDocument& document) {
    if (!document.measurement) return "nor whether it is metric";
    return *document.measurement == 1 ? "only that it is metric" : "only that it is not metric";
  }

  const Source& source_;
  const DrawingFileOptions& options_;
  DiagnosticSink& sink_;
};

}  // namespace

bool AppendDxf(const Source& source, const PlanStorey& storey, const DrawingFileOptions& options, PlanIr& plan, DiagnosticSink& sink) {
  return Frontend(source, options, sink).Run(storey, plan);
}

}  // namespace plumb::compiler
