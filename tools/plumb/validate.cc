#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#ifdef PLUMB_WITH_COMPILER
#include "compiler/compile.h"
#include "compiler/validate.h"
#endif
#include "schema/agraph_reader.h"
#include "schema/files.h"
#include "tools/plumb/command.h"

namespace plumb::tools {
namespace {

struct ValidateFlags {
  std::string path;
  bool json = false, strict = false;
};

// The FlatBuffers identifier stands in bytes 4 to 7. A damaged .agraph may have lost it, so the name counts too.
bool IsAGraph(const std::string& path, const std::vector<uint8_t>& bytes) {
  constexpr uint8_t kIdentifier[] = {'P', 'L', 'A', 'G'};
  return path.ends_with(".agraph") || (bytes.size() >= 8 && std::equal(std::begin(kIdentifier), std::end(kIdentifier), bytes.begin() + 4));
}

#ifdef PLUMB_WITH_COMPILER
using compiler::Diagnostic;

Status Judge(const ValidateFlags& flags, const std::vector<Diagnostic>& diagnostics, Session& session) {
  session.console.Print(flags.json ? compiler::DiagnosticsToJson(diagnostics, flags.path)
                                   : compiler::DiagnosticsToText(diagnostics, flags.path, std::max<size_t>(1, diagnostics.size())));
  const Severity gravest_allowed = flags.strict ? Severity::kRemark : Severity::kWarning;
  const bool sound = std::all_of(diagnostics.begin(), diagnostics.end(),
                                 [&](const Diagnostic& d) { return compiler::SeverityOf(d.kind) <= gravest_allowed; });
  if (sound) session.console.Info(flags.path + ": sound");
  return sound ? Status::kFine : Status::kFindings;
}

Status ValidateAGraph(const ValidateFlags& flags, const AGraph& graph, Session& session) {
  return Judge(flags, compiler::ValidateGraph(graph), session);
}

Status ValidatePlan(const ValidateFlags& flags, Session& session) {
  const compiler::CompileResult result = compiler::Compile(flags.path);
  const Status status = Judge(flags, result.diagnostics.all(), session);
  if (result.has_internal_error()) return session.Fail({ErrorCode::kInternal, fmt::format("the compiler failed on `{}`", flags.path)});
  if (!result.graph) return session.Fail({ErrorCode::kPlanUnsuitable, fmt::format("`{}` gives no A-Graph", flags.path)});
  return status;
}
#else
// Without the compiler's checks an A-Graph that the reader takes is sound.
Status ValidateAGraph(const ValidateFlags& flags, const AGraph&, Session& session) {
  if (flags.json) session.console.Print(nlohmann::ordered_json{{"source", flags.path}, {"diagnostics", nlohmann::ordered_json::array()}}.dump(1) + "\n");
  session.console.Info(flags.path + ": readable");
  return Status::kFine;
}

Status ValidatePlan(const ValidateFlags& flags, Session& session) {
  return session.Fail({ErrorCode::kNotAnAGraph, fmt::format("`{}` is no A-Graph, and this program was built without the compiler", flags.path)});
}
#endif

// A file that cannot be read as an A-Graph, in the form that diagnostics have.
std::string UnreadableJson(const std::string& path, const Error& error) {
  nlohmann::ordered_json out;
  out["source"] = path;
  out["diagnostics"] = {{{"code", fmt::format("E{}", static_cast<int>(error.code))}, {"severity", "error"}, {"message", error.message}}};
  return out.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Status RunValidate(const ValidateFlags& flags, Session& session) {
  const auto bytes = ReadFileBytes(flags.path);
  if (!bytes) return session.Fail(bytes.error());
  if (!IsAGraph(flags.path, *bytes)) return ValidatePlan(flags, session);
  const auto graph = ReadAGraph(*bytes);
  if (!graph && flags.json) session.console.Print(UnreadableJson(flags.path, graph.error()));
  return graph ? ValidateAGraph(flags, *graph, session) : session.Fail(graph.error());
}

}  // namespace

void AddValidate(CLI::App& app, Session& session) {
  auto flags = std::make_shared<ValidateFlags>();
  CLI::App* sub = AddSubcommand(app, session, "validate", "Check a plan or an A-Graph and write nothing",
                                "  plumb validate house.ifc\n"
                                "  plumb validate house.agraph --json");
  sub->add_option("PLAN|FILE.agraph", flags->path, "what to check")->required();
  sub->add_flag("--json", flags->json, "print the diagnostics as JSON");
  sub->add_flag("--strict", flags->strict, "warnings are findings too");
  sub->callback([flags, &session] { session.status = RunValidate(*flags, session); });
}

}  // namespace plumb::tools
