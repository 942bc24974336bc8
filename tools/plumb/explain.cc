#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <vector>

#include "compiler/diagnostics/explanation.h"
#include "tools/names/names.h"
#include "tools/plumb/command.h"

namespace plumb::tools {
namespace {

using compiler::DiagnosticKind;

std::string List() {
  std::string out;
  for (const DiagnosticKind kind : compiler::AllDiagnosticKinds()) {
    out += fmt::format("{} {:<8} {:<24} {}\n", compiler::CodeOf(kind), compiler::SeverityName(compiler::SeverityOf(kind)),
                       compiler::NameOf(kind), compiler::RuleOf(kind));
  }
  return out;
}

Error Unknown(const std::string& code) {
  std::vector<std::string> names;
  for (const DiagnosticKind kind : compiler::AllDiagnosticKinds()) names.emplace_back(compiler::NameOf(kind));
  const std::string near = NearestName(code, names);
  return {ErrorCode::kBadOption, fmt::format("there is no diagnostic `{}`; {}", code,
                                             near.empty() ? "`plumb explain` lists them" : fmt::format("did you mean `{}`?", near))};
}

Status RunExplain(const std::string& code, Session& session) {
  if (code.empty()) {
    session.console.Print(List());
    return Status::kFine;
  }
  const auto kind = compiler::FindDiagnosticKind(code);
  if (!kind) return session.Fail(Unknown(code));
  session.console.Print(compiler::ExplanationText(*kind));
  return Status::kFine;
}

}  // namespace

void AddExplain(CLI::App& app, Session& session) {
  auto code = std::make_shared<std::string>();
  CLI::App* sub = AddSubcommand(app, session, "explain", "Say what a diagnostic code means, why it matters to a robot and how to mend it",
                                "  plumb explain PL7103\n"
                                "  plumb explain RoomWithoutDoorway\n"
                                "  plumb explain");
  sub->add_option("CODE", *code, "code or name of a diagnostic; without it, all of them are listed")->type_name("");
  sub->callback([code, &session] { session.status = RunExplain(*code, session); });
}

}  // namespace plumb::tools
