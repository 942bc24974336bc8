#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#ifdef PLUMB_WITH_COMPILER
#include "compiler/compile.h"
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

Status ValidateAGraph(const ValidateFlags& flags, const std::vector<uint8_t>& bytes, Session& session) {
  const auto graph = ReadAGraph(bytes);
  if (flags.json) {
    nlohmann::ordered_json out;
    out["source"] = flags.path;
    out["diagnostics"] = nlohmann::ordered_json::array();
    if (!graph) {
      out["diagnostics"].push_back(
          {{"code", fmt::format("E{}", static_cast<int>(graph.error().code))}, {"severity", "error"}, {"message", graph.error().message}});
    }
    session.console.Print(out.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  }
  if (!graph) return session.Fail(graph.error());
  session.console.Info(fmt::format("{}: a sound A-Graph, {} rooms, {} surfaces", flags.path, graph->rooms.size(), graph->surfaces.size()));
  return Status::kFine;
}

#ifdef PLUMB_WITH_COMPILER
Status ValidatePlan(const ValidateFlags& flags, Session& session) {
  const compiler::CompileResult result = compiler::Compile(flags.path);
  const auto& diagnostics = result.diagnostics.all();
  if (flags.json) {
    session.console.Print(compiler::DiagnosticsToJson(diagnostics, flags.path));
  } else {
    session.console.Print(compiler::DiagnosticsToText(diagnostics, flags.path, diagnostics.size()));
  }
  if (!result.graph) return session.Fail({ErrorCode::kPlanUnsuitable, fmt::format("`{}` gives no A-Graph", flags.path)});
  if (result.diagnostics.has_errors()) return Status::kFindings;
  if (flags.strict && result.diagnostics.Count(Severity::kWarning) > 0) return Status::kFindings;
  session.console.Info(fmt::format("{}: a sound plan", flags.path));
  return Status::kFine;
}
#endif

Status RunValidate(const ValidateFlags& flags, Session& session) {
  const auto bytes = ReadFileBytes(flags.path);
  if (!bytes) return session.Fail(bytes.error());
  if (IsAGraph(flags.path, *bytes)) return ValidateAGraph(flags, *bytes, session);
#ifdef PLUMB_WITH_COMPILER
  return ValidatePlan(flags, session);
#else
  return session.Fail({ErrorCode::kNotAnAGraph, fmt::format("`{}` is no A-Graph, and this program was built without the compiler", flags.path)});
#endif
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
