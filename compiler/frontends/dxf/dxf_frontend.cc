#include "compiler/frontends/dxf/dxf_frontend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "compiler/frontends/drawing/layer_rules.h"
#include "compiler/frontends/drawing/plane.h"
#include "compiler/frontends/drawing/sheets.h"
#include "compiler/frontends/drawing/units.h"
#include "compiler/frontends/dxf/dxf_document.h"
#include "compiler/frontends/dxf/dxf_unfold.h"

namespace plumb::compiler {
namespace {

// $INSUNITS by number; others are no units that buildings are drawn in.
constexpr std::array<const char*, 15> kInsunits = {"", "in", "ft", "", "mm", "cm", "m", "km", "", "", "yd", "", "", "", "dm"};

constexpr double kFar_m = 1000;

std::optional<LengthUnit> StatedUnit(const DxfDocument& document) {
  if (!document.insunits || *document.insunits < 0 || *document.insunits >= static_cast<int>(kInsunits.size())) return std::nullopt;
  return FindUnit(kInsunits[static_cast<size_t>(*document.insunits)]);
}

// Of a plan on its sheet or in its file.
class Frontend {
 public:
  Frontend(const Source& source, const DxfOptions& options, DiagnosticSink& sink) : source_(source), options_(options), sink_(sink) {}

  bool Run(const PlanStorey& storey, PlanIr& plan) {
    const std::optional<DxfDocument> document = ReadDxfDocument(source_.bytes, {}, sink_);
    if (!document) return false;
    for (const auto& [type, count] : document->not_read)
      sink_.Emit(DiagnosticKind::kEntityNotRead, {}, fmt::format("{} entities of type {} are not read", count, type));
    const std::optional<LayerRules> rules = RulesFor(*document);
    if (!rules) return false;
    std::optional<Drawing> drawing = Unfold(*document, *rules, {options_.max_block_depth, options_.max_paths, 100'000}, sink_);
    if (!drawing) return false;
    if (drawing->paths.empty()) {
      sink_.Emit(DiagnosticKind::kNothingDrawn, {}, "the drawing has no lines in its model space that could be walls");
      return false;
    }
    ToMetres(*document, *drawing);
    MoveToOrigin(*drawing, plan);
    MendRoles(*drawing);
    return AppendSheets(std::move(*drawing), storey, plan);
  }

 private:
  std::optional<LayerRules> RulesFor(const DxfDocument& document) {
    if (!options_.layers.empty()) {
      Expected<LayerRules> rules = LoadLayerRules(options_.layers);
      if (rules) return std::move(*rules);
      sink_.Emit(DiagnosticKind::kLayerRulesUnreadable, {}, rules.error().message);
      return std::nullopt;
    }
    const LayerChoice choice = ChooseLayerRules(WeighLayers(document));
    sink_.Emit(DiagnosticKind::kLayersGuessed, {},
               choice.confidence > 0 ? fmt::format("layers are read by the set `{}`, which knows those of {:.0f} % of what is drawn", choice.rules->name(), 100 * choice.confidence)
                                     : "no layer is known to have walls; all that is drawn may be walls (set `none`)",
               "--layers names another set or a file");
    return *choice.rules;
  }

  void ToMetres(const DxfDocument& document, Drawing& drawing) {
    double metres = 1;
    if (const auto given = FindUnit(options_.unit)) {
      metres = given->metres;
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
    for (DrawnPath& path : drawing.paths) {
      for (auto& p : path.points) p *= metres;
      for (Arc& arc : path.arcs) arc.center *= metres, arc.radius_m *= metres;
    }
    for (DrawnText& text : drawing.texts) text.at *= metres, text.height_m *= metres;
  }

  // Of drawings in coordinates of a country: numbers near zero keep their precision. All storeys of a plan have one origin.
  void MoveToOrigin(Drawing& drawing, PlanIr& plan) {
    Eigen::AlignedBox2d box;
    for (const DrawnPath& path : drawing.paths) box.extend(BoxOf(path.points));
    const Eigen::Vector2d center = box.center();
    if (plan.storeys.empty() && center.norm() > kFar_m) {
      plan.origin << center.array().round(), 0;
      sink_.Emit(DiagnosticKind::kFarOrigin, {}, fmt::format("the plan lies {:.0f} km from its zero; it is compiled about ({:.0f}, {:.0f})", center.norm() / 1000, plan.origin.x(), plan.origin.y()));
    }
    const Eigen::Vector2d shift = -plan.origin.head<2>();
    for (DrawnPath& path : drawing.paths) {
      for (auto& p : path.points) p += shift;
      for (Arc& arc : path.arcs) arc.center += shift;
    }
    for (DrawnText& text : drawing.texts) text.at += shift;
  }

  static const char* Measurement(const DxfDocument& document) {
    if (!document.measurement) return "nor whether it is metric";
    return *document.measurement == 1 ? "only that it is metric" : "only that it is not metric";
  }

  bool AppendSheets(Drawing drawing, const PlanStorey& storey, PlanIr& plan) {
    std::vector<Drawing> sheets = SplitSheets(std::move(drawing));
    if (options_.sheet > static_cast<int>(sheets.size())) {
      sink_.Emit(DiagnosticKind::kSheetMissing, {}, fmt::format("sheet {} is asked for, but the drawing has {} plan(s)", options_.sheet, sheets.size()));
      return false;
    }
    if (options_.sheet > 0) return AppendStorey(sheets[static_cast<size_t>(options_.sheet - 1)], storey, options_.drawing, plan, sink_);
    if (sheets.size() > 1) {
      sink_.Emit(DiagnosticKind::kSeveralSheets, {},
                 fmt::format("{} plans of about the same size lie side by side; they are taken for storeys, {:.2f} m from floor to floor, from left to right and below to above",
                             sheets.size(), options_.drawing.heights.storey_m),
                 "--sheet N takes one of them");
    }
    for (size_t i = 0; i < sheets.size(); ++i) {
      PlanStorey here = storey;
      if (sheets.size() > 1) {
        here.name = fmt::format("{} {}", storey.name, i + 1);
        here.elevation_m += static_cast<double>(i) * options_.drawing.heights.storey_m;
      }
      if (!AppendStorey(sheets[i], here, options_.drawing, plan, sink_)) return false;
    }
    return true;
  }

  const Source& source_;
  const DxfOptions& options_;
  DiagnosticSink& sink_;
};

}  // namespace

std::string DxfOptions::Check() const {
  if (const std::string fault = drawing.Check(); !fault.empty()) return fault;
  if (!unit.empty() && !FindUnit(unit)) return fmt::format("DxfOptions.unit = {}; must be mm, cm, dm, m, km, in, ft or yd", unit);
  if (sheet < 0) return fmt::format("DxfOptions.sheet = {}; must not be negative", sheet);
  return {};
}

bool AppendDxf(const Source& source, const PlanStorey& storey, const DxfOptions& options, PlanIr& plan, DiagnosticSink& sink) {
  return Frontend(source, options, sink).Run(storey, plan);
}

}  // namespace plumb::compiler
