#include "compiler/compile.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <system_error>
#include <vector>

#include "compiler/validate.h"
#include "schema/agraph_writer.h"
#include "schema/counted.h"
#include "schema/files.h"
#include "tools/plumb/command.h"
#include "tools/plumb/compile_limits.h"
#include "tools/plumb/flag_names.h"
#include "tools/plumb/inputs.h"
#include "tools/plumb/outputs.h"
#include "tools/plumb/usage_errors.h"

namespace plumb::tools {
namespace {

struct CompileFlags {
  std::vector<std::string> plans, storeys;
  std::string plan;  // the first one
  std::string output, diagnostics_json;
  size_t max_per_kind = 3;
  compiler::CompileOptions options;
};

std::string Summary(const AGraph& g, const std::string& output) {
  return fmt::format("{}: {}, {}, {}, {}, {}, {}, {}", output, Counted(g.storeys.size(), "storey"), Counted(g.walls.size(), "wall"),
                     Counted(g.surfaces.size(), "surface"), Counted(g.rooms.size(), "room"), Counted(g.doorways.size(), "doorway"),
                     Counted(g.windows.size(), "window"), Counted(g.mesh.triangles.size(), "triangle"));
}

// With --quiet the errors alone remain.
void Tell(const CompileFlags& flags, const std::vector<compiler::Diagnostic>& diagnostics, Console& console) {
  if (!console.quiet()) {
    const std::string text = compiler::DiagnosticsToText(diagnostics, flags.plan, flags.max_per_kind);
    if (!text.empty()) console.Info(text.substr(0, text.size() - 1));
    return;
  }
  std::vector<compiler::Diagnostic> errors;
  std::copy_if(diagnostics.begin(), diagnostics.end(), std::back_inserter(errors),
               [](const compiler::Diagnostic& d) { return compiler::SeverityOf(d.kind) == Severity::kError; });
  const std::string text = compiler::DiagnosticsToText(errors, flags.plan, flags.max_per_kind);
  if (!text.empty()) console.Error(text.substr(0, text.size() - 1));
}

// NAME=FILE@ELEVATION. The file may have `@` in its name, the name `=` not.
Expected<compiler::StoreyDrawing> ParseStorey(const std::string& text) {
  const size_t equals = text.find('='), at = text.rfind('@');
  const auto wrong = [&] {
    return Fail(ErrorCode::kBadOption, fmt::format("--storey {}: must be NAME=FILE@ELEVATION, as in EG=ground.dxf@0", text));
  };
  if (equals == std::string::npos || equals == 0 || at == std::string::npos || at < equals + 2) return wrong();
  compiler::StoreyDrawing out{text.substr(0, equals), text.substr(equals + 1, at - equals - 1), 0};
  const char *first = text.data() + at + 1, *last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, out.elevation_m);
  if (error != std::errc() || end != last || !std::isfinite(out.elevation_m) || std::abs(out.elevation_m) > 1e4) return wrong();
  return out;
}

// However its path is written: `./a.dxf` and `a.dxf`.
bool IsSameFile(const std::string& a, const std::string& b) {
  std::error_code error;
  return a == b || std::filesystem::equivalent(a, b, error) ||
         std::filesystem::path(a).lexically_normal() == std::filesystem::path(b).lexically_normal();
}

// Every plan that is given must be the file of a storey, so that none is passed over in silence.
Expected<std::vector<compiler::StoreyDrawing>> StoreysOf(const CompileFlags& flags) {
  std::vector<compiler::StoreyDrawing> out;
  for (const std::string& text : flags.storeys) {
    Expected<compiler::StoreyDrawing> storey = ParseStorey(text);
    if (!storey) return tl::unexpected(storey.error());
    const bool known = std::any_of(out.begin(), out.end(), [&](const auto& s) { return s.name == storey->name; });
    if (known) return Fail(ErrorCode::kBadOption, fmt::format("--storey {}; there is a storey `{}` already", text, storey->name));
    out.push_back(std::move(*storey));
  }
  for (const std::string& plan : flags.plans) {
    const bool used = std::any_of(out.begin(), out.end(), [&](const auto& s) { return IsSameFile(s.path, plan); });
    if (!used && (flags.plans.size() > 1 || !out.empty()))
      return Fail(ErrorCode::kBadOption,
                  fmt::format("`{}`: of several drawings each is a storey; state --storey NAME={}@ELEVATION", plan, plan));
  }
  return out;
}

compiler::CompileResult CompileWithin(const CompileFlags& flags, const std::vector<compiler::StoreyDrawing>& storeys) {
  const CompileLimits limits(flags.plan);
  return storeys.empty() ? compiler::Compile(flags.plan, flags.options) : compiler::CompileStoreys(storeys, flags.options);
}

Status RunCompile(CompileFlags& flags, Session& session) {
  if (const std::string wrong = flags.options.Check(); !wrong.empty()) return session.Fail({ErrorCode::kBadOption, InFlags(wrong)});
  const auto storeys = StoreysOf(flags);
  if (!storeys) return session.Fail(storeys.error());
  if (flags.plans.empty() && storeys->empty()) return session.Fail({ErrorCode::kBadOption, "PLAN is required"});
  flags.plan = flags.plans.empty() ? storeys->front().path : flags.plans.front();
  std::vector<std::string> inputs = flags.plans;
  for (const compiler::StoreyDrawing& storey : *storeys) inputs.push_back(storey.path);
  const auto apart = CheckOutputs({{"--output", flags.output}, {"--diagnostics-json", flags.diagnostics_json}}, inputs);
  if (!apart) return session.Fail(apart.error());
  const compiler::CompileResult result = CompileWithin(flags, *storeys);
  const auto& diagnostics = result.diagnostics.all();
  Tell(flags, diagnostics, session.console);
  if (!flags.diagnostics_json.empty()) {
    const std::string json = compiler::ReportToString(compiler::ReportOf(flags.plan, result), compiler::ReportFormat::kJson);
    const auto written = WriteFileAtomically(flags.diagnostics_json, std::string_view(json));
    if (!written) return session.Fail(written.error());
  }
  if (result.has_internal_error())
    return session.Fail({ErrorCode::kInternal, fmt::format("the compiler failed on `{}`; see above", flags.plan)});
  if (!result.graph) {
    const auto fits = CheckInputs({{flags.plan, InputKind::kPlan}});
    if (!fits && fits.error().code == ErrorCode::kBadOption) return session.Fail(fits.error());
    return session.Fail({ErrorCode::kPlanUnsuitable, fmt::format("`{}` gives no A-Graph; see above", flags.plan)});
  }
  if (const auto written = WriteAGraphFile(*result.graph, flags.output); !written) return session.Fail(written.error());
  session.console.Info(Summary(*result.graph, flags.output));
  return result.diagnostics.has_errors() ? Status::kFindings : Status::kFine;
}

}  // namespace

void AddCompileOptions(CLI::App& subcommand, compiler::CompileOptions& options) {
  subcommand.add_option("--section-height", options.section_height_m, "height above the storey's zero at which walls are cut, m");
  subcommand.add_option("--snap-radius", options.snap_radius_m, "corners of walls closer than this become one, m");
  subcommand.add_option("--min-room-area", options.min_room_area_m2, "smaller faces between walls are shafts, not rooms, m2");
  subcommand.add_option("--max-gap", options.max_gap_m, "walls closer than this are taken to meet where that keeps two rooms apart, m");
  subcommand.add_option("--unit", options.unit,
                        "of a drawing or mesh: m, cm, mm, in or ft; else as the file states, if walls and doors then have usual sizes");
  subcommand.add_option("--up", options.up, "of meshes: x, y or z; else as stated by the file or seen in its walls");
  subcommand.add_option("--model-path", options.model_path, "of Gazebo worlds: folders besides the world's own that hold included models")
      ->envname("GAZEBO_MODEL_PATH")
      ->type_name("FOLDER")
      ->default_str("")
      ->delimiter(':');
  subcommand.add_option("--divide-open-plans", options.divide_open_plans, "along the plan's spaces where no walls do; else one room")
      ->default_str("true");
  compiler::DrawingFileOptions& drawing = options.drawing;
  subcommand.add_option("--scale", drawing.scale_m,
                        "of a drawing: metres of one unit of the file, instead of --unit; for SVG the unit of its viewBox");
  subcommand.add_option("--layers", drawing.layers, "of a drawing: aia, english, german, french, italian, spanish, none, or a TOML file")
      ->type_name("SET|FILE");
  subcommand.add_option("--sheet", drawing.sheet, "of a drawing with several plans side by side, from 1; 0: all, as storeys");
  subcommand.add_option("--storey-height", drawing.plan.heights.storey_m, "of a drawing: height of its walls, m");
  subcommand.add_option("--door-height", drawing.plan.heights.door_m, "of a drawing: height of its doors, m");
  subcommand.add_option("--sill-height", drawing.plan.heights.sill_m, "of a drawing: where its windows begin, m");
  subcommand.add_option("--window-top", drawing.plan.heights.window_top_m, "of a drawing: where its windows end, m");
  subcommand.add_option("--wall-thickness", drawing.plan.mass.single_line_thickness_m, "of a drawing: of walls drawn as single lines, m");
}

void AddCompile(CLI::App& app, Session& session) {
  auto flags = std::make_shared<CompileFlags>();
  CLI::App* sub =
      AddSubcommand(app, session, "compile", "Turn a floor plan into an A-Graph: rooms, wall surfaces, doorways, triangles",
                    "  plumb compile house.ifc -o house.agraph\n"
                    "  plumb compile house.ifc.gz -o house.agraph --diagnostics-json house.json\n"
                    "  plumb compile flat.svg --scale 0.01 -o flat.agraph\n"
                    "  plumb compile plan.dxf --layers german --unit cm -o plan.agraph\n"
                    "  plumb compile site.stl --unit mm --up z -o site.agraph\n"
                    "  plumb compile house.world --model-path ~/models -o house.agraph\n"
                    "  plumb compile a.dxf b.svg --storey EG=a.dxf@0 --storey OG=b.svg@3.0 -o house.agraph\n"
                    "Status 1: the A-Graph is written, but has errors in it: in a plan without walls no robot can localize, say.\n"
                    "Status 2: nothing is written: the file is damaged, too large, of no schema that is read, or has no building in it.");
  sub->add_option("PLAN", flags->plans,
                  "the plan: IFC (STEP), a drawing (DXF, SVG), a mesh (OBJ, PLY, STL, glTF, COLLADA) or a Gazebo world (SDF); plain, "
                  "gzipped or in a ZIP archive; with --storey it need not be named again")
      ->type_name("")
      ->default_str("");
  sub->add_option("--storey", flags->storeys, "a drawing's storey and the height of its floor, m; once for each")
      ->type_name("NAME=FILE@ELEVATION")
      ->default_str("")
      ->allow_extra_args(false);
  sub->add_option("-o,--output", flags->output, "the A-Graph to write")->required()->check(NotEmpty)->type_name("FILE.agraph");
  sub->add_option("--diagnostics-json", flags->diagnostics_json, "write what the compiler has to say about the plan as JSON")
      ->type_name("FILE");
  sub->add_option("--max-per-kind", flags->max_per_kind, "print at most this many diagnostics of a kind");
  AddCompileOptions(*sub, flags->options);
  sub->callback([flags, &session] { session.status = RunCompile(*flags, session); });
}

}  // namespace plumb::tools
