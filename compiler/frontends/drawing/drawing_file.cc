#include "compiler/frontends/drawing/drawing_file.h"

#include <fmt/format.h>

#include <cmath>

#include "compiler/frontends/drawing/arc_fit.h"
#include "compiler/frontends/drawing/plane.h"
#include "compiler/frontends/drawing/sheets.h"
#include "compiler/frontends/drawing/units.h"
#include "schema/counted.h"

namespace plumb::compiler {
namespace {

constexpr double kFar_m = 1000;

// Of drawings in coordinates of a country: numbers near zero keep their precision. All storeys of a plan have one origin.
void MoveToOrigin(Drawing& drawing, PlanIr& plan, DiagnosticSink& sink) {
  Eigen::AlignedBox2d box;
  for (const DrawnPath& path : drawing.paths) box.extend(BoxOf(path.points));
  const Eigen::Vector2d center = box.center();
  if (plan.storeys.empty() && center.norm() > kFar_m) {
    plan.origin << center.array().round(), 0;
    sink.Emit(DiagnosticKind::kFarOrigin, {},
              fmt::format("the plan lies {:.0f} km from its zero; it is compiled about ({:.0f}, {:.0f})", center.norm() / 1000,
                          plan.origin.x(), plan.origin.y()));
  }
  const Eigen::Vector2d shift = -plan.origin.head<2>();
  for (DrawnPath& path : drawing.paths) {
    for (auto& p : path.points) p += shift;
    for (Arc& arc : path.arcs) arc.center += shift;
  }
  for (DrawnText& text : drawing.texts) text.at += shift;
  for (DrawnSpace& space : drawing.spaces) {
    for (auto& p : space.outline) p += shift;
  }
}

bool AppendSheets(Drawing drawing, const PlanStorey& storey, const DrawingFileOptions& options, PlanIr& plan, DiagnosticSink& sink) {
  std::vector<Drawing> sheets = SplitSheets(std::move(drawing));
  if (options.sheet > static_cast<int>(sheets.size())) {
    sink.Emit(DiagnosticKind::kSheetMissing, {},
              fmt::format("sheet {} is asked for, but the drawing has {}", options.sheet, Counted(sheets.size(), "plan")));
    return false;
  }
  if (options.sheet > 0) return AppendStorey(sheets[static_cast<size_t>(options.sheet - 1)], storey, options.plan, plan, sink);
  if (sheets.size() > 1) {
    sink.Emit(DiagnosticKind::kSeveralSheets, {},
              fmt::format("{} plans of about the same size lie side by side; they are taken for storeys, {:.2f} m from floor to floor, "
                          "from left to right and below to above",
                          sheets.size(), options.plan.heights.storey_m),
              "--sheet N takes one of them");
  }
  for (size_t i = 0; i < sheets.size(); ++i) {
    PlanStorey here = storey;
    if (sheets.size() > 1) {
      here.name = fmt::format("{} {}", storey.name, i + 1);
      here.elevation_m += static_cast<double>(i) * options.plan.heights.storey_m;
    }
    if (!AppendStorey(sheets[i], here, options.plan, plan, sink)) return false;
  }
  return true;
}

}  // namespace

std::string DrawingFileOptions::Check() const {
  if (const std::string fault = plan.Check(); !fault.empty()) return fault;
  if (!unit.empty() && !FindUnit(unit)) return fmt::format("DrawingFileOptions.unit = {}; must be mm, cm, dm, m, km, in, ft or yd", unit);
  if (!(scale_m >= 0 && scale_m < 1e4)) return fmt::format("DrawingFileOptions.scale_m = {}; must be in [0, 10000)", scale_m);
  if (scale_m > 0 && !unit.empty())
    return fmt::format("DrawingFileOptions.scale_m = {}; must not be given besides unit = {}", scale_m, unit);
  if (sheet < 0) return fmt::format("DrawingFileOptions.sheet = {}; must not be negative", sheet);
  return {};
}

std::optional<double> DrawingFileOptions::GivenScale() const {
  if (scale_m > 0) return scale_m;
  const std::optional<LengthUnit> given = FindUnit(unit);
  return given ? std::optional(given->metres) : std::nullopt;
}

// A hint, where those that were told know little that another set knows.
std::string BetterRules(const std::vector<LayerWeight>& layers, double known_ratio) {
  constexpr double kMuchBetter = 0.2;
  const LayerChoice choice = ChooseLayerRules(layers);
  if (choice.confidence < known_ratio + kMuchBetter) return {};
  return fmt::format("the set `{}` knows those of {:.0f} %; without --layers it is taken", choice.rules->name(), 100 * choice.confidence);
}

std::optional<LayerRules> RulesFor(const std::vector<LayerWeight>& layers, const DrawingFileOptions& options, DiagnosticSink& sink) {
  if (!options.layers.empty()) {
    Expected<LayerRules> rules = LoadLayerRules(options.layers);
    if (rules) {
      double known = 0, all = 0;
      for (const LayerWeight& layer : layers) {
        all += layer.weight;
        if (rules->UseOf(layer.name) != LayerUse::kUnknown) known += layer.weight;
      }
      sink.Emit(DiagnosticKind::kLayersGuessed, {},
                fmt::format("layers are read by the rules `{}`, as told; they know those of {:.0f} % of what is drawn", rules->name(),
                            all > 0 ? 100 * known / all : 0.0),
                BetterRules(layers, all > 0 ? known / all : 0.0));
      return std::move(*rules);
    }
    sink.Emit(DiagnosticKind::kLayerRulesUnreadable, {}, rules.error().message);
    return std::nullopt;
  }
  const LayerChoice choice = ChooseLayerRules(layers);
  sink.Emit(DiagnosticKind::kLayersGuessed, {},
            choice.confidence > 0 ? fmt::format("layers are read by the set `{}`, which knows those of {:.0f} % of what is drawn",
                                                choice.rules->name(), 100 * choice.confidence)
                                  : "no layer is known to have walls; all that is drawn may be walls (set `none`)",
            "--layers names another set or a file");
  return *choice.rules;
}

void CheckGivenScale(double metres, const Drawing& drawing, DiagnosticSink& sink) {
  const DrawnSizes sizes = MeasureSizes(drawing);
  if (sizes.extent == 0 || SizesHold(FirmSizes(sizes, metres), metres)) return;
  sink.Emit(DiagnosticKind::kUnitContradicted, {},
            fmt::format("the unit is given as {:.4g} m, but {}; it is taken as given", metres,
                        DescribeSizes(sizes, {fmt::format("units of {:.4g} m", metres), metres})),
            "without --unit and --scale it is found from the sizes of walls and doors");
}

void ScaleDrawing(double metres, Drawing& drawing) {
  for (DrawnPath& path : drawing.paths) {
    for (auto& p : path.points) p *= metres;
    for (Arc& arc : path.arcs) arc.center *= metres, arc.radius_m *= metres;
    path.stroke_m *= metres;
  }
  for (DrawnText& text : drawing.texts) text.at *= metres, text.height_m *= metres;
  for (DrawnSpace& space : drawing.spaces) {
    for (auto& p : space.outline) p *= metres;
  }
}

bool AppendDrawing(Drawing drawing, const PlanStorey& storey, const DrawingFileOptions& options, PlanIr& plan, DiagnosticSink& sink) {
  MoveToOrigin(drawing, plan, sink);
  MendRoles(drawing);
  FitArcs(drawing);
  return AppendSheets(std::move(drawing), storey, options, plan, sink);
}

}  // namespace plumb::compiler
