#include "compiler/validate.h"

#include <CLI/CLI.hpp>
#include <map>
#include <memory>

#include "schema/files.h"
#include "tools/plumb/command.h"
#include "tools/plumb/compile_limits.h"
#include "tools/plumb/flag_names.h"
#include "tools/plumb/inputs.h"
#include "tools/plumb/outputs.h"

namespace plumb::tools {
namespace {

using compiler::ReportFormat;

const std::map<std::string, ReportFormat> kFormats = {
    {"text", ReportFormat::kText}, {"json", ReportFormat::kJson}, {"sarif", ReportFormat::kSarif}};

struct ValidateFlags {
  std::string path, output, format = "text";
  bool json = false;
  compiler::ValidateOptions options;
};

compiler::Report ValidateWithin(const ValidateFlags& flags) {
  const CompileLimits limits(flags.path);
  return compiler::ValidateFile(flags.path, flags.options);
}

Status RunValidate(const ValidateFlags& flags, Session& session) {
  if (const std::string wrong = flags.options.compile.Check(); !wrong.empty()) return session.Fail({ErrorCode::kBadOption, InFlags(wrong)});
  if (const auto apart = CheckOutputs({{"--output", flags.output}}, {flags.path}); !apart) return session.Fail(apart.error());
  const compiler::Report report = ValidateWithin(flags);
  const std::string text = compiler::ReportToString(report, flags.json ? ReportFormat::kJson : kFormats.at(flags.format));
  if (flags.output.empty()) {
    session.console.Print(text);
  } else if (const auto written = WriteFileAtomically(flags.output, text); !written) {
    return session.Fail(written.error());
  }
  if (report.outcome == compiler::Outcome::kBadInput && KindOf(flags.path) != InputKind::kAGraph) {
    const auto fits = CheckInputs({{flags.path, InputKind::kPlan}});
    if (!fits && fits.error().code == ErrorCode::kBadOption) session.console.Error(fits.error().message);
  }
  return static_cast<Status>(report.outcome);
}

}  // namespace

void AddValidate(CLI::App& app, Session& session) {
  auto flags = std::make_shared<ValidateFlags>();
  CLI::App* sub = AddSubcommand(app, session, "validate", "Say whether a robot can localize in a plan or A-Graph and, if not, why",
                                "  plumb validate house.ifc\n"
                                "  plumb validate plan.svg --scale 0.01\n"
                                "  plumb validate house.agraph --format json\n"
                                "  plumb validate house.ifc --strict --format sarif -o house.sarif");
  sub->add_option("PLAN|FILE.agraph", flags->path, "what to check")->required()->type_name("");
  sub->add_option("--format", flags->format, "of what is printed: text, json or sarif (2.1.0)")
      ->check(CLI::IsMember({"text", "json", "sarif"}));
  sub->add_flag("--json", flags->json, "the same as --format json");
  sub->add_option("-o,--output", flags->output, "write it into this file instead of printing it")->type_name("FILE");
  sub->add_flag("--strict", flags->options.strict, "warnings are findings too");
  AddCompileOptions(*sub, flags->options.compile);
  sub->callback([flags, &session] { session.status = RunValidate(*flags, session); });
}

}  // namespace plumb::tools
