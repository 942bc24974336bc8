#include "compiler/frontends/svg/svg_frontend.h"

#include <fmt/format.h>

#include <utility>

#include "compiler/frontends/drawing/hatching.h"
#include "compiler/frontends/drawing/room_outlines.h"
#include "compiler/frontends/drawing/strokes.h"
#include "compiler/frontends/svg/svg_document.h"
#include "compiler/frontends/svg/svg_drawing.h"
#include "compiler/frontends/svg/svg_scale.h"

namespace plumb::compiler {
namespace {

void ReportReading(const SvgDocument& document, DiagnosticSink& sink) {
  for (const auto& [element, count] : document.not_read)
    sink.Emit(DiagnosticKind::kEntityNotRead, {}, fmt::format("{} <{}> elements are not read", count, element));
  for (const std::string& layer : document.hidden_layers)
    sink.Emit(DiagnosticKind::kLayerHidden, {}, fmt::format("layer `{}` is not displayed; what is drawn on it is left out", layer));
}

double MetresOf(const SvgDocument& document, const Drawing& drawing, const DrawingFileOptions& options, DiagnosticSink& sink) {
  if (const auto given = options.GivenScale()) {
    CheckGivenScale(*given, drawing, sink);
    return *given;
  }
  const ScaleChoice choice = ChooseScale(MeasureSizes(drawing), document.unit_on_paper_m, RatiosIn(drawing));
  if (choice.origin == ScaleChoice::Origin::kSizes) {
    const bool stated = document.unit_on_paper_m.has_value();
    sink.Emit(stated ? DiagnosticKind::kUnitContradicted : DiagnosticKind::kScaleGuessed, {}, choice.reason, "--scale gives the metres of one unit");
  } else if (choice.origin == ScaleChoice::Origin::kRatio) {
    sink.Emit(DiagnosticKind::kUnitGuessed, {}, choice.reason, "--scale overrides");
  }
  return choice.metres;
}

}  // namespace

bool AppendSvg(const Source& source, const PlanStorey& storey, const DrawingFileOptions& options, PlanIr& plan, DiagnosticSink& sink) {
  SvgReadOptions read_options;
  read_options.max_depth = options.max_depth;
  const std::optional<SvgDocument> document = ReadSvgDocument(source, read_options, sink);
  if (!document) return false;
  ReportReading(*document, sink);
  const std::optional<LayerRules> rules = RulesFor(WeighNames(*document), options, sink);
  if (!rules) return false;
  Drawing drawing = DrawingFromSvg(*document, *rules);
  if (const size_t lines = DropHatching(drawing); lines > 0)
    sink.Emit(DiagnosticKind::kHatchingLeftOut, {}, fmt::format("{} lines lie beside each other at equal distances; they are taken for hatching or stairs and left out", lines));
  if (drawing.paths.empty()) {
    sink.Emit(DiagnosticKind::kNothingDrawn, {}, "the drawing has no visible lines that could be walls");
    return false;
  }
  ScaleDrawing(MetresOf(*document, drawing, options, sink), drawing);
  WidenStrokes(drawing);
  if (drawing.spaces.empty()) AddOutlinedRooms(drawing);
  return AppendDrawing(std::move(drawing), storey, options, plan, sink);
}

}  // namespace plumb::compiler
