#include "compiler/compile.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <exception>
#include <map>
#include <new>
#include <string_view>
#include <vector>

#include "compiler/emit/emit.h"
#include "compiler/emit/freed_memory.h"
#include "compiler/frontends/dxf/dxf_frontend.h"
#include "compiler/frontends/ifc/ifc_frontend.h"
#include "compiler/frontends/mesh/mesh_frontend.h"
#include "compiler/frontends/sdf/sdf_frontend.h"
#include "compiler/frontends/svg/svg_frontend.h"
#include "compiler/passes/alias_forecast.h"
#include "compiler/passes/build_agraph.h"
#include "compiler/source/sha256.h"
#include "compiler/source/source.h"
#include "compiler/validate_graph.h"
#include "schema/source_paths.h"

namespace plumb::compiler {
namespace {

constexpr double kLeastStorey_m = 1.8;  // from floor to floor
constexpr double kWingOverlap_m = 1.0;  // of two wings of one storey: they share a wall at most

PassOptions PassOptionsFrom(const CompileOptions& options) {
  PassOptions out;
  out.section_height_m = options.section_height_m;
  out.verify = options.verify_stages;
  out.planar_map.snap_radius_m = options.snap_radius_m;
  out.bridges.max_gap_m = options.max_gap_m;
  out.division.divide = options.divide_open_plans;
  out.rooms.min_area_m2 = options.min_room_area_m2;
  return out;
}

// As they stand in the file: what the result depends on.
std::vector<Option> Recorded(const CompileOptions& options) {
  std::vector<Option> out = {{"section_height_m", fmt::format("{}", options.section_height_m)},
                             {"snap_radius_m", fmt::format("{}", options.snap_radius_m)},
                             {"max_gap_m", fmt::format("{}", options.max_gap_m)},
                             {"divide_open_plans", options.divide_open_plans ? "true" : "false"},
                             {"min_room_area_m2", fmt::format("{}", options.min_room_area_m2)}};
  if (!options.up.empty()) out.push_back({"up", options.up});
  return out;
}

void AddDrawingOptions(const DrawingFileOptions& options, std::vector<Option>& out) {
  const HeightOptions& heights = options.plan.heights;
  out.insert(out.end(), {{"storey_height_m", fmt::format("{}", heights.storey_m)},
                         {"door_height_m", fmt::format("{}", heights.door_m)},
                         {"sill_height_m", fmt::format("{}", heights.sill_m)},
                         {"window_top_m", fmt::format("{}", heights.window_top_m)},
                         {"wall_thickness_m", fmt::format("{}", options.plan.mass.single_line_thickness_m)},
                         {"unit", options.unit},
                         {"scale_m", fmt::format("{}", options.scale_m)},
                         {"layers", options.layers},
                         {"sheet", fmt::format("{}", options.sheet)}});
}

void ReportHeights(const HeightOptions& heights, DiagnosticSink& sink) {
  sink.Emit(DiagnosticKind::kHeightsAssumed, {},
            fmt::format("a drawing has no heights: storeys of {:.2f} m, doors of {:.2f} m, windows from {:.2f} m to {:.2f} m are assumed",
                        heights.storey_m, heights.door_m, heights.sill_m, heights.window_top_m));
}

bool IsDrawing(SourceFormat format) { return format == SourceFormat::kDxf || format == SourceFormat::kSvg; }

// One drawing more of a plan. Its source names all of them, and its hash changes with each.
bool AddDrawing(const Source& source, const StoreyDrawing& drawing, const DrawingFileOptions& options, PlanIr& plan, DiagnosticSink& sink) {
  const PlanStorey storey{{}, drawing.name, {}, drawing.elevation_m};
  if (!IsDrawing(source.format)) {
    sink.Emit(DiagnosticKind::kUnknownFormat, {},
              fmt::format("`{}` is {}; storeys are drawings in DXF or SVG", source.path, FormatName(source.format)));
    return false;
  }
  const bool read =
      source.format == SourceFormat::kSvg ? AppendSvg(source, storey, options, plan, sink) : AppendDxf(source, storey, options, plan, sink);
  if (!read) return false;
  if (plan.source_path.empty()) {
    plan.source_path = source.path;
    plan.source_format = SchemaName(source.format);
    plan.source_sha256 = source.sha256;
    return true;
  }
  plan.source_path += std::string(kBetweenSourcePaths) + source.path;
  plan.source_sha256 = Sha256Hex(plan.source_sha256 + source.sha256);
  return true;
}

// What a plan has so far.
struct PlanSize {
  size_t storeys, elements, openings, spaces;
};
PlanSize SizeOf(const PlanIr& plan) { return {plan.storeys.size(), plan.elements.size(), plan.openings.size(), plan.spaces.size()}; }

void StateFile(const PlanSize& from, const std::string& path, PlanIr& plan) {
  const auto state = [&path](auto& items, size_t first) {
    for (size_t i = first; i < items.size(); ++i) items[i].location.file = path;
  };
  state(plan.storeys, from.storeys);
  state(plan.elements, from.elements);
  state(plan.openings, from.openings);
  state(plan.spaces, from.spaces);
}

// Storeys one over the other need room for a person between their floors; drawings of two wings may have the same height.
bool LieApart(const PlanSize& last, const StoreyDrawing& storey, PlanIr& plan, DiagnosticSink& sink) {
  Eigen::AlignedBox3d own;
  for (size_t e = last.elements; e < plan.elements.size(); ++e) own.extend(Bounds(plan.elements[e].uncut));
  for (size_t s = 0; s < last.storeys; ++s) {
    if (storey.elevation_m - plan.storeys[s].elevation_m >= kLeastStorey_m) continue;
    Eigen::AlignedBox3d other;
    for (size_t e = 0; e < last.elements; ++e) {
      if (plan.elements[e].storey == s) other.extend(Bounds(plan.elements[e].uncut));
    }
    if (own.isEmpty() || other.isEmpty() || !own.intersects(other)) continue;
    const Eigen::Vector3d common = own.intersection(other).sizes();
    if (common.head<2>().minCoeff() < kWingOverlap_m) continue;
    sink.Emit(DiagnosticKind::kStoreysCollide, {},
              fmt::format("the floors of `{}` and `{}` are {:.2f} m apart, and their drawings lie over each other", plan.storeys[s].name,
                          storey.name, storey.elevation_m - plan.storeys[s].elevation_m),
              "--storey NAME=FILE@ELEVATION takes the height of each floor, m");
    return false;
  }
  return true;
}

// In the order of elevation, as PlanIr has its storeys. Where there are several files, messages say which.
std::optional<PlanIr> ReadDrawings(std::vector<StoreyDrawing> storeys, const DrawingFileOptions& options, DiagnosticSink& sink) {
  std::stable_sort(storeys.begin(), storeys.end(), [](const auto& a, const auto& b) { return a.elevation_m < b.elevation_m; });
  PlanIr plan;
  for (const StoreyDrawing& storey : storeys) {
    DiagnosticSink of_file;
    const PlanSize before = SizeOf(plan);
    const std::optional<Source> source = LoadSource(storey.path, of_file);
    const bool read = source && IsSupported(*source, of_file) && AddDrawing(*source, storey, options, plan, of_file) &&
                      LieApart(before, storey, plan, of_file);
    for (Diagnostic d : of_file.all()) {
      if (storeys.size() > 1) d.location.file = storey.path;
      sink.Emit(d.kind, d.location, d.message, d.hint);
    }
    if (!read) return std::nullopt;
    if (storeys.size() > 1) StateFile(before, storey.path, plan);
  }
  ReportHeights(options.plan.heights, sink);
  return plan;
}

DrawingFileOptions DrawingOptionsFrom(const CompileOptions& options) {
  DrawingFileOptions out = options.drawing;
  if (!options.unit.empty()) out.unit = options.unit;
  return out;
}

MeshOptions MeshOptionsFrom(const CompileOptions& options) {
  MeshOptions out;
  out.unit = options.unit;
  out.up = options.up;
  out.section_height_m = options.section_height_m;
  out.model_path = options.model_path;
  return out;
}

std::optional<PlanIr> ReadPlan(const std::string& path, const CompileOptions& options, DiagnosticSink& sink) {
  const std::optional<Source> source = LoadSource(path, sink);
  if (!source || !IsSupported(*source, sink)) return std::nullopt;
  if (source->format == SourceFormat::kSdf) return ReadSdf(*source, sink, MeshOptionsFrom(options));
  if (IsMesh(source->format)) return ReadMesh(*source, sink, MeshOptionsFrom(options));
  if (!IsDrawing(source->format)) return ReadIfc(*source, sink);
  PlanIr plan;
  if (!AddDrawing(*source, {"Storey", path, 0.0}, DrawingOptionsFrom(options), plan, sink)) return std::nullopt;
  ReportHeights(options.drawing.plan.heights, sink);
  return plan;
}

// The solids are most of the memory: what the passes alone need is given back before the triangles are made of the bodies. Places in the
// source stay.
void ReleaseSolidsOfPasses(PlanIr& plan) {
  for (PlanElement& element : plan.elements) element.uncut = {};
  for (PlanOpening& opening : plan.openings) opening.body = {};
  for (PlanSpace& space : plan.spaces) space.body = {};
  ReturnFreedMemory();
}

// What checks of the graph know by GUID only is shown where it stands in the source. Of doorways that join nothing the passes have told.
void AddLocated(const PlanIr& plan, const std::vector<Diagnostic>& found, DiagnosticSink& sink) {
  std::map<std::string_view, const SourceLocation*> by_guid;
  const auto add = [&by_guid](const auto& items) {
    for (const auto& item : items) by_guid.emplace(item.guid, &item.location);
  };
  add(plan.elements);
  add(plan.openings);
  add(plan.spaces);
  add(plan.storeys);
  for (const Diagnostic& d : found) {
    if (d.kind == DiagnosticKind::kDoorwayWithoutRoom) continue;
    const auto known = d.location.guid.empty() ? by_guid.end() : by_guid.find(d.location.guid);
    sink.Emit(d.kind, known == by_guid.end() ? d.location : *known->second, d.message, d.hint);
  }
}

std::optional<AGraph> Run(std::optional<PlanIr> plan, const CompileOptions& options, DiagnosticSink& sink) {
  if (!plan) return std::nullopt;
  ReturnFreedMemory();  // of the source and the frontend's tables
  std::optional<Built> built = BuildAGraph(*plan, PassOptionsFrom(options), sink);
  if (!built) return std::nullopt;
  AGraph graph = std::move(built->graph);
  built.reset();  // the maps of the floors
  ReleaseSolidsOfPasses(*plan);
  EmitMesh(*plan, graph);
  MoveToPlanFrame(*plan, graph);
  ForecastAliases({}, graph);
  ReturnFreedMemory();  // of its sections
  AddLocated(*plan, ValidateGraph(graph), sink);
  std::vector<Option> recorded = Recorded(options);
  if (plan->source_format == "DXF" || plan->source_format == "SVG")
    AddDrawingOptions(DrawingOptionsFrom(options), recorded);
  else if (!options.unit.empty())
    recorded.push_back({"unit", options.unit});
  EmitProvenance(*plan, recorded, sink, graph);
  return graph;
}

}  // namespace

std::string CompileOptions::Check() const {
  if (!(section_height_m > 0 && section_height_m < 10))
    return fmt::format("CompileOptions.section_height_m = {}; must be in (0, 10)", section_height_m);
  if (!(snap_radius_m > 0 && snap_radius_m <= 0.05))
    return fmt::format("CompileOptions.snap_radius_m = {}; must be in (0, 0.05]", snap_radius_m);
  if (!(max_gap_m >= 0 && max_gap_m <= 0.5)) return fmt::format("CompileOptions.max_gap_m = {}; must be in [0, 0.5]", max_gap_m);
  if (const std::string wrong = MeshOptionsFrom(*this).Check(); !wrong.empty()) return wrong;
  if (!(min_room_area_m2 >= 0)) return fmt::format("CompileOptions.min_room_area_m2 = {}; must not be negative", min_room_area_m2);
  return DrawingOptionsFrom(*this).Check();
}

bool CompileResult::has_internal_error() const {
  const auto& all = diagnostics.all();
  return std::any_of(all.begin(), all.end(), [](const Diagnostic& d) { return d.kind == DiagnosticKind::kInternalError; });
}

namespace {

template <class Read>
CompileResult CompileFrom(const std::string& path, const CompileOptions& options, const Read& read) {
  CompileResult out;
  if (const std::string wrong = options.Check(); !wrong.empty()) {
    out.diagnostics.Emit(DiagnosticKind::kInternalError, {}, wrong);
    return out;
  }
  try {
    out.graph = Run(read(out.diagnostics), options, out.diagnostics);
  } catch (const std::bad_alloc&) {
    out.graph.reset();
    out.diagnostics.Emit(DiagnosticKind::kPlanTooComplex, {}, fmt::format("`{}` needs more memory than there is", path));
  } catch (const std::exception& e) {
    out.graph.reset();
    out.diagnostics.Emit(DiagnosticKind::kInternalError, {}, fmt::format("the compiler failed: {}", e.what()));
  }
  return out;
}

}  // namespace

CompileResult Compile(const std::string& path, const CompileOptions& options) {
  return CompileFrom(path, options, [&](DiagnosticSink& sink) { return ReadPlan(path, options, sink); });
}

CompileResult CompileStoreys(const std::vector<StoreyDrawing>& storeys, const CompileOptions& options) {
  const std::string path = storeys.empty() ? std::string() : storeys.front().path;
  return CompileFrom(path, options, [&](DiagnosticSink& sink) { return ReadDrawings(storeys, DrawingOptionsFrom(options), sink); });
}

}  // namespace plumb::compiler
