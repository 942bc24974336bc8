#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "compiler/diagnostics/diagnostic.h"
#include "tools/plumb/command.h"

namespace plumb::tools {
namespace {

using compiler::DiagnosticKind;

constexpr DiagnosticKind kAllKinds[] = {
#define PLUMB_DIAGNOSTIC(code, name, severity, rule) DiagnosticKind::k##name,
#include "compiler/diagnostics/diagnostic_kinds.def"
#undef PLUMB_DIAGNOSTIC
};

const char* SeverityName(Severity severity) {
  constexpr const char* kNames[] = {"note", "remark", "warning", "error"};
  return kNames[static_cast<size_t>(severity)];
}

std::string Describe(DiagnosticKind kind) {
  return fmt::format("{} {} ({}): {}\n", compiler::CodeOf(kind), compiler::NameOf(kind), SeverityName(compiler::SeverityOf(kind)),
                     compiler::RuleOf(kind));
}

Status RunExplain(const std::string& code, Session& session) {
  bool found = false;
  for (const DiagnosticKind kind : kAllKinds) {
    if (!code.empty() && code != compiler::CodeOf(kind) && code != compiler::NameOf(kind)) continue;
    session.console.Print(Describe(kind));
    found = true;
  }
  if (found) return Status::kFine;
  return session.Fail({ErrorCode::kBadOption, fmt::format("there is no diagnostic `{}`; `plumb explain` lists them", code)});
}

}  // namespace

void AddExplain(CLI::App& app, Session& session) {
  auto code = std::make_shared<std::string>();
  CLI::App* sub = AddSubcommand(app, session, "explain", "Say what a diagnostic code means",
                                "  plumb explain PL2001\n"
                                "  plumb explain");
  sub->add_option("CODE", *code, "code or name of a diagnostic; without it, all of them");
  sub->callback([code, &session] { session.status = RunExplain(*code, session); });
}

}  // namespace plumb::tools
